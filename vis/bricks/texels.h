#pragma once

#include "vis/optics/adaptive_step.h"
#include "volume/bricks/brick_source.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

/// From bricks to the texels of a 3D texture: gathered with a halo, filtered, normalised and packed. No GL.
namespace tessera::vis {

inline constexpr int kHalo = 2; ///< texels around what a texture covers: central differences reach that far
inline constexpr int kBlockTexels = kStepBlock; ///< edge of a block of the empty-space map

/// How the numbers of a texture become values: physical = offset + scale * texel.
struct TexelEncoding {
    bool coverage = false;   ///< a second set of components says how much of a sample is present
    bool exact = false;      ///< 32-bit float texels, else 16-bit normalised
    bool prefiltered = true; ///< Prefiltered (volume/reconstruct/reconstruct.h), else the samples as they are
    double offset = 0, scale = 1;
    bool operator==(const TexelEncoding&) const = default;
};

/// Value range of a channel at one time, over present samples.
struct ChannelStats {
    double min = 0, max = 0;
    bool someAbsent = false, allAbsent = false;
};
ChannelStats channelStats(std::span<const volume::BrickStats> bricks);

/// The range that a channel is encoded with: that of all its times, so that unchanged bricks can keep their texels, if
/// the time uses at least a sixteenth of it; else its own.
ChannelStats commonStats(const ChannelStats& own, Range allTimes);

/// The encoding that holds a channel: unfiltered values in [0, 1] of the 16 bits minus headroom for the prefilter's
/// overshoot (2/3 of the range on either side). Categorical values are stored as integers.
TexelEncoding makeEncoding(const ChannelStats& stats, bool categorical, bool exact, bool prefiltered);

/// Texels of a level: (CC) its samples, (BCC) one texel per pair of samples.
glm::ivec3 levelTexels(const volume::BrickGrid& grid, int level);

/// Which texels of which level: [begin, end).
struct TexelBox {
    int level = 0;
    glm::ivec3 begin{0}, end{0};
    glm::ivec3 size() const { return end - begin; }
};

/// Texel ranges per block, over everything that interpolation inside the block can touch; min > max: all absent.
struct BlockRanges {
    glm::ivec3 count{0};
    int edge = kBlockTexels; ///< of a block, in texels of `level`
    int level = 0;
    std::vector<float> min, max; ///< texel units, x fastest
};

/// A box of texels with kHalo more on every side, ready to upload: components interleaved, x fastest.
///     CC: value (, coverage)      BCC: even, odd (, even coverage, odd coverage)
/// An absent sample is 0 in value and coverage.
struct TexelBlock {
    glm::ivec3 size{0}; ///< with halo
    int components = 1;
    std::vector<std::uint16_t> normalised; ///< either this
    std::vector<float> exact;              ///< or this
    BlockRanges blocks;
    const void* data() const { return exact.empty() ? static_cast<const void*>(normalised.data()) : exact.data(); }
    std::size_t bytes() const { return normalised.size() * 2 + exact.size() * 4; }
};

using SharedBrick = std::shared_ptr<const volume::BrickSamples>;
/// Returns one decoded brick; called from several threads at once.
using ReadBrick = std::function<SharedBrick(const volume::BrickKey&)>;

/// Samples of a box with `halo` texels around it, the nearest sample repeated beyond the lattice.
volume::BrickSamples gatherBox(const volume::BrickGrid& grid, const volume::BrickKey& which, const TexelBox& box,
                               int halo, const ReadBrick& read);

/// Reads, filters and packs a box. Throws what `read` throws.
TexelBlock makeTexels(const volume::BrickGrid& grid, const volume::BrickKey& which, const TexelBox& box,
                      const TexelEncoding& encoding, const ReadBrick& read);

} // namespace tessera::vis
