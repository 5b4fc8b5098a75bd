#pragma once

#include "app/importer/readers/source.h"

#include <cstddef>
#include <vector>

namespace tessera::importer {

/// Gives a source the times of a file, ascending, and tells which of the file's steps each of them is. Of equal times
/// the last is kept, with a note; where one is no number, the steps are counted. A single time stays.
std::vector<std::size_t> giveTimes(Source& source, const std::vector<double>& times);

} // namespace tessera::importer
