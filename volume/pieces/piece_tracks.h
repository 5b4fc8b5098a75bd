#pragma once

#include "volume/pieces/piece_graph.h"

namespace tessera::volume {

/// Leaves out what is too small, numbers the pieces that remain and tells the events, from pieces and links alone; see
/// findPieces. `times`: how many there are.
void followPieces(PieceGraph& graph, double leastVolume, int times);

} // namespace tessera::volume
