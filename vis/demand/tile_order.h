#pragma once

#include "vis/demand/picture_contrast.h"

#include <vector>

/// In which order the tiles of a picture are drawn.
namespace tessera::vis {

/// Tiles of `edge` pixels that cover `whole`, those in its middle first, where the user looks; the last ones of a row
/// or column are smaller.
std::vector<Tile> tilesFromMiddle(const Tile& whole, int edge);
/// The same tiles of a picture of `size` pixels, those with the most contrast first.
std::vector<Tile> tilesByContrast(const Tile& whole, int edge, glm::ivec2 size, const PictureContrast& contrast);

} // namespace tessera::vis
