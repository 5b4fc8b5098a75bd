#pragma once

#include "volume/pieces/piece_graph.h"

#include <vector>

namespace tessera::app {

/// Where the tracks of pieces run in a graph over time.
struct PieceLanes {
    std::vector<int> lane; ///< by track; the first entry is of none
    int count = 0;
};

/// A lane for each track: beside those that it comes from or becomes one with, so that lines cross little; tracks that
/// are never there at once may share one.
PieceLanes pieceLanes(const volume::PieceGraph& graph);

} // namespace tessera::app
