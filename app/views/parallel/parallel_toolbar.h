#pragma once

#include "app/views/parallel/parallel_page.h"

namespace tessera::app {

/// The line above parallel coordinates: parameters, their order, times, the look, exports and the share selected.
void drawParallelToolbar(ViewContext& context, ParallelCoordinatesView& view, const std::vector<int>& shown,
                         const std::vector<ParallelState>& states);

/// The names of channels, in order.
std::vector<std::string> orderedNames(const volume::DatasetInfo& info, const std::vector<int>& channels);

/// Puts a name into a list, or takes it out.
void toggleName(std::vector<std::string>& names, const std::string& name);

} // namespace tessera::app
