#pragma once

#include "volume/field/lattice.h"

#include <cstddef>
#include <glm/vec3.hpp>

namespace tessera::volume {

/// How a lattice is cut into bricks, the same at every time and for every parameter.
///
/// A brick is a cube of `brickSize` texels a side; a texel holds one sample of each sublattice, so on BCC a brick
/// covers brickSize x brickSize x 2 brickSize storage samples. Bricks at the far faces are smaller (true sizes, no
/// padding). Level l keeps every 2^l-th sample of each sublattice: level sample i lies where fine sample i * 2^l of its
/// sublattice lies, shifted by levelPhase(l) fine cells.
struct BrickGrid {
    Lattice lattice;
    int brickSize = 32; ///< texels a side, a power of two
    int levels = 4;     ///< level 0 is full resolution; 2^(levels - 1) <= brickSize
    /// Offset of a level-1 sample from its fine sample, in fine cells: 0 for filters whose coarse samples coincide with
    /// fine ones (all but the (1, x) family), 0.5 for means of two.
    double phase = 0;

    bool operator==(const BrickGrid&) const = default;

    /// Bricks per axis.
    glm::ivec3 count() const;
    std::size_t brickCount() const;
    /// Bricks are numbered x fastest.
    std::size_t numberOf(glm::ivec3 brick) const;
    glm::ivec3 indexOf(std::size_t number) const;
    /// Fine storage samples of a brick: [begin, end). BCC: z counts slices and `begin.z` is even.
    glm::ivec3 begin(glm::ivec3 brick) const;
    glm::ivec3 end(glm::ivec3 brick) const;
    /// Storage samples of a brick at a level, per sublattice ceil(n / 2^l).
    glm::ivec3 brickSamples(glm::ivec3 brick, int level) const;
    /// Storage samples of the whole lattice at a level.
    glm::ivec3 levelSamples(int level) const;
    /// The finest level with at most so many samples, else the coarsest.
    int levelWithin(double samples) const;
    /// Storage index, at that level, of the first sample of a brick.
    glm::ivec3 levelBegin(glm::ivec3 brick, int level) const;
    /// Shift in fine cells: sublattice sample i of level l lies at fine cell i * 2^l + levelPhase(l) (+ 1/2 on odd
    /// BCC).
    double levelPhase(int level) const;
};

/// Which brick: `channel` indexes DatasetInfo::channels().
struct BrickKey {
    int channel = 0, time = 0, level = 0;
    glm::ivec3 index{0};
    bool operator==(const BrickKey&) const = default;
};

struct BrickKeyHash {
    std::size_t operator()(const BrickKey& key) const {
        std::size_t hash = 1469598103934665603ull;
        for (int part : {key.channel, key.time, key.level, key.index.x, key.index.y, key.index.z})
            hash = (hash ^ static_cast<std::size_t>(static_cast<unsigned>(part))) * 1099511628211ull;
        return hash;
    }
};

} // namespace tessera::volume
