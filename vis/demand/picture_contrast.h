#pragma once

#include "vis/raycast/tile.h"

#include <array>
#include <span>

namespace tessera::vis {

/// How much neighbouring pixels of a small picture differ, by places of the whole one: there it lacks most.
class PictureContrast {
public:
    void clear() { cells_.fill(0); }
    /// Takes a box of a picture of `size` pixels in. `rgba`: its pixels, linear, premultiplied, row by row.
    void add(glm::ivec2 size, const Tile& box, std::span<const float> rgba);
    /// Mean over a tile of a picture of `size` pixels of what was taken in, 0..1.
    double of(const Tile& tile, glm::ivec2 size) const;

private:
    static constexpr int kCells = 64; ///< along each axis
    static glm::ivec2 cellOf(glm::ivec2 pixel, glm::ivec2 size) { return pixel * kCells / size; }

    std::array<float, std::size_t(kCells) * kCells> cells_{}; ///< largest differences of pixels there
};

} // namespace tessera::vis
