#pragma once

#include "volume/field/field.h"
#include "volume/reconstruct/reconstruct.h"

#include <cstddef>
#include <cstdint>

/// Nearest neighbours of samples in memory: inside of resampling.
namespace tessera::volume {

/// The number of each sample's part (volume/field/part_masks.h).
struct PartNumbers {
    const Mask* mask;
    std::uint8_t operator()(std::size_t index) const { return mask != nullptr ? (*mask)[index] : std::uint8_t(1); }
};

/// Calls `visit(a, b)` with the memory indices of the nearest neighbours of a sample, each beside the one across.
template <class Visit> void forOppositePairs(const Lattice& lattice, glm::ivec3 at, const Visit& visit) {
    const auto index = [&](int x, int y, int z) {
        return lattice.index(clampToLattice(lattice.kind, lattice.size, at + glm::ivec3(x, y, z)));
    };
    if (lattice.kind == LatticeKind::CC) {
        visit(index(-1, 0, 0), index(1, 0, 0));
        visit(index(0, -1, 0), index(0, 1, 0));
        visit(index(0, 0, -1), index(0, 0, 1));
        return;
    }
    const int lo = (at.z & 1) - 1; // an even sample's neighbours have indices -1 and 0, an odd one's 0 and 1
    for (int y : {0, 1})
        for (int x : {0, 1}) visit(index(lo + x, lo + y, -1), index(lo + 1 - x, lo + 1 - y, 1));
}

} // namespace tessera::volume
