#pragma once

#include "volume/field/dataset.h"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

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

/// Statistics of a brick that are known without decoding it: physical values of present samples at full resolution. An
/// empty brick has presentFraction 0 and min > max.
struct BrickStats {
    float min = 0, max = 0;
    float presentFraction = 1;
};

/// Mean and histogram of a brick, known without decoding it: physical values of present, finite samples at full
/// resolution.
struct BrickDistribution {
    std::uint64_t samples = 0; ///< 0: the rest means nothing
    Range range;               ///< of the values; lo = hi where all are one
    double mean = 0;           ///< at most 2^-24 of the range beside the true one
    /// Bin b of B (up to 32, depending on the number of samples) covers range.lo + [b, b + 1] / B of the range; a value
    /// on a border belongs to the bin above, range.hi to the last bin. The counts are exact and sum to `samples`.
    std::vector<std::uint32_t> counts;
    double step = 0; ///< values lie at range.lo + i * step; 0: anywhere
};

/// Importance and detail of a brick, 0 to 1 each (volume/bricks/brick_importance.h).
struct BrickImportance {
    float importance = 0; ///< by mean, contrast and entropy
    float detail = 0;     ///< by the energy of its details
    float largest() const { return importance > detail ? importance : detail; }
};

/// Change of a brick between two times: physical values at full resolution. A sample that is present at only one of
/// them has infinite change. Rounded up, so that 0 means that all samples are equal.
struct BrickChange {
    float max = 0, rms = 0; ///< rms: over the samples present
    bool operator==(const BrickChange&) const = default;
};

/// The smallest float that is not below a value.
float roundedUp(double value);

/// Upper bound on the change over two steps, from those of each step (Minkowski's inequality).
BrickChange accumulated(const BrickChange& first, const BrickChange& second);

/// Bounds for the magnitude of a vector from those of its components.
BrickChange magnitudeChange(std::span<const BrickChange> components);
/// The importance of a magnitude: the largest of its components.
BrickImportance magnitudeImportance(std::span<const BrickImportance> components);

/// Samples of one brick at one level, without border: physical values, x fastest, storage order of the lattice.
struct BrickSamples {
    glm::ivec3 size{0};
    std::vector<float> values;
    std::vector<std::uint8_t> present; ///< empty: all present; else one byte per sample, 0 = absent (value undefined)

    bool isPresent(std::size_t index) const { return volume::isPresent(present, index); }
};

/// A data set as bricks; implemented by in-memory data sets and by archives. All functions may be called from any
/// thread at any time.
class BrickSource {
public:
    virtual ~BrickSource() = default;
    virtual const DatasetInfo& info() const = 0;
    virtual const BrickGrid& grid() const = 0;
    /// Statistics of a brick; `key.level` is ignored. Cheap for an archive; an in-memory source may have to load a
    /// frame.
    virtual BrickStats stats(const BrickKey& key) const = 0;
    /// Mean and histogram of a brick; `key.level` is ignored. As cheap as `stats`; nothing where they are not known.
    virtual std::optional<BrickDistribution> distribution(const BrickKey& key) const;
    /// Importance of a brick; `key.level` is ignored. As cheap as `stats`; nothing where it is not known.
    virtual std::optional<BrickImportance> importance(const BrickKey& key) const;
    /// Upper bound on the change of a brick at full resolution from key.time to `toTime`, which may be earlier; empty
    /// if unknown. For coarser levels only a change of 0 is meaningful: they are unchanged, too. As cheap as `stats`.
    virtual std::optional<BrickChange> change(const BrickKey& key, int toTime) const;
    /// Reads, and if need be decodes, one brick. Throws Error when the data is damaged.
    virtual BrickSamples read(const BrickKey& key) const = 0;
};

/// Samples of a brick with a border of `halo` samples of each sublattice, as the renderer needs them: CC (n + 2 halo)
/// per axis; BCC (nx + 2 halo, ny + 2 halo, 2 (texels z + 2 halo)), with alternating even and odd slices, starting with
/// an even one. Beyond the lattice the nearest sample is repeated, including its flag. `read` returns one brick without
/// border.
BrickSamples gather(const BrickGrid& grid, const BrickKey& key, int halo,
                    const std::function<BrickSamples(const BrickKey&)>& read);

} // namespace tessera::volume
