#pragma once

#include "tests/codec/plain/codes.h"
#include "tests/codec/plain/decoder.h"

/// Boxes of cells and the transforms along their lines (FORMAT.md 4.3, 4.7).
namespace tessera::codec::plain {

Size half(const Size& size);

/// A box of cells, x fastest.
struct Box {
    Size size{};
    std::vector<Cell> cells;
    Cell& at(int x, int y, int z) {
        return cells[(std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) * std::size_t(size[0]) + std::size_t(x)];
    }
    Cell& at(const Size& p) { return at(p[0], p[1], p[2]); }
};

Box makeBox(const Size& size);

/// Calls `visit` with each place of [lo, hi), x fastest.
template <class Visit> void places(const Size& lo, const Size& hi, Visit&& visit) {
    for (int z = lo[2]; z < hi[2]; ++z)
        for (int y = lo[1]; y < hi[1]; ++y)
            for (int x = lo[0]; x < hi[0]; ++x) visit(Size{x, y, z});
}

/// The flags of a box in the places of the coded order: `steps` splits of what is left.
void split(Box& flags, int steps);

/// 4.3, one line
std::vector<Cell> undo(const std::vector<Cell>& cells, int wavelet, bool asFloat);
/// The opposite of undo.
std::vector<Cell> redo(const std::vector<Cell>& cells, int wavelet, bool asFloat);

/// 4.7: adds to odd samples at full resolution what their even neighbours foresee, or makes those of a coarser level.
void predictOdd(Box& even, Box& odd, int level);

} // namespace tessera::codec::plain
