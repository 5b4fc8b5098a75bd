#pragma once

#include "vis/optics/adaptive_step.h"
#include "volume/bricks/brick_source.h"
#include "volume/reconstruct/prefilter.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

/// Converts bricks to texels of a 3D texture: gathers them with a halo, filters, normalises and packs. Without OpenGL.
namespace tessera::vis {

inline constexpr int kHalo = 2;                 ///< texels around the covered box, for central differences
inline constexpr int kBlockTexels = kStepBlock; ///< edge of a block for empty-space skipping

/// How texel values map to physical values: physical = offset + scale * texel.
struct TexelEncoding {
    bool coverage = false; ///< extra components hold the presence of each sample, 0..1
    bool exact = false;    ///< 32-bit float texels, else 16-bit normalised
    volume::Prefilter prefilter = volume::Prefilter::Linear;
    double offset = 0, scale = 1;
    bool operator==(const TexelEncoding&) const = default;
};

/// Value range of the present samples of a channel at one time.
struct ChannelStats {
    double min = 0, max = 0;
    bool someAbsent = false, allAbsent = false;
};
ChannelStats channelStats(std::span<const volume::BrickStats> bricks);

/// The range used for encoding: that of all times, so that unchanged bricks can share texels, if this time covers at
/// least a sixteenth of it; else its own range. Beyond that of all times lie samples that were corrected for pictures,
/// by up to kCentredHeadroom of its width (volume/sources/centred_samples.h): then all times have that much more.
ChannelStats commonStats(const ChannelStats& own, Range allTimes);

/// The encoding of a channel: unfiltered values in [0, 1], 16 bits with headroom on either side for the overshoot of
/// the prefilter. Categorical values are stored as integers.
TexelEncoding makeEncoding(const ChannelStats& stats, bool categorical, bool exact, volume::Prefilter prefilter);

/// Texels of a level: one per sample (CC), or one per pair of samples (BCC).
glm::ivec3 levelTexels(const volume::BrickGrid& grid, int level);

/// A box [begin, end) of texels of a level.
struct TexelBox {
    int level = 0;
    glm::ivec3 begin{0}, end{0};
    glm::ivec3 size() const { return end - begin; }
};

/// Texel ranges per block over all texels that interpolation inside it can read, linear or cubic; min > max: all
/// absent.
struct BlockRanges {
    glm::ivec3 count{0};
    int edge = kBlockTexels; ///< edge of a block in texels of `level`
    int level = 0;
    std::vector<float> min, max; ///< texel units, x fastest
};

/// A box of texels with kHalo more on every side, ready to upload: components interleaved, x fastest.
///     CC: value (, coverage)      BCC: even, odd (, even coverage, odd coverage)
/// An absent sample is 0 in value and coverage.
struct TexelBlock {
    glm::ivec3 size{0}; ///< with halo
    int components = 1;
    std::vector<std::uint16_t> normalised; ///< 16-bit encoding, or
    std::vector<float> exact;              ///< float encoding
    BlockRanges blocks;
    const void* data() const { return exact.empty() ? static_cast<const void*>(normalised.data()) : exact.data(); }
    std::size_t bytes() const { return normalised.size() * 2 + exact.size() * 4; }
};

using SharedBrick = std::shared_ptr<const volume::BrickSamples>;
/// Returns one decoded brick; called concurrently.
using ReadBrick = std::function<SharedBrick(const volume::BrickKey&)>;

/// Copies the samples of a box with `halo` texels around it; beyond the lattice the nearest sample is repeated.
volume::BrickSamples gatherBox(const volume::BrickGrid& grid, const volume::BrickKey& which, const TexelBox& box,
                               int halo, const ReadBrick& read);

/// Reads, filters and packs a box. Throws what `read` throws.
TexelBlock makeTexels(const volume::BrickGrid& grid, const volume::BrickKey& which, const TexelBox& box,
                      const TexelEncoding& encoding, const ReadBrick& read);

} // namespace tessera::vis
