#pragma once

#include "app/values/table.h"
#include "app/views/parallel/parallel_axes.h"
#include "app/views/parallel/parallel_query.h"

#include <string>
#include <vector>

namespace tessera::app {

/// A row for each triple of bins that holds samples: of an answer that counted them together. `selected`: the name of
/// what is selected, "" for nothing.
Table cloudTable(const ParallelResult& result, const std::vector<ParallelAxis>& axes, const std::string& selected);

} // namespace tessera::app
