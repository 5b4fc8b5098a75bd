#pragma once

#include "vis/raycast/tile.h"

#include <vector>

/// In which order the tiles of a picture are drawn.
namespace tessera::vis {

/// Tiles of `edge` pixels that cover `whole`, those in its middle first, where the user looks; the last ones of a row
/// or column are smaller.
std::vector<Tile> tilesFromMiddle(const Tile& whole, int edge);

} // namespace tessera::vis
