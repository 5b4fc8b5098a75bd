#include "vis/gl/texels.h"

#include "volume/parallel.h"
#include "volume/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <mutex>

namespace tessera::vis {

using volume::BrickGrid;
using volume::BrickKey;
using volume::BrickSamples;
using volume::LatticeKind;

ChannelStats channelStats(std::span<const volume::BrickStats> bricks) {
    ChannelStats stats{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), false, false};
    for (const volume::BrickStats& brick : bricks) {
        if (brick.presentFraction < 1) stats.someAbsent = true;
        if (brick.presentFraction <= 0 || !(brick.min <= brick.max)) continue;
        stats.min = std::min(stats.min, double(brick.min));
        stats.max = std::max(stats.max, double(brick.max));
    }
    if (!(stats.min <= stats.max)) stats = {0, 0, true, true};
    return stats;
}

ChannelStats commonStats(const ChannelStats& own, Range allTimes) {
    constexpr double kFairShare = 1.0 / 16, kRounding = 1e-6;
    const double width = allTimes.hi - allTimes.lo, beyond = kRounding * width;
    const bool within = own.min >= allTimes.lo - beyond && own.max <= allTimes.hi + beyond;
    if (own.allAbsent || !within || !(own.max - own.min >= kFairShare * width)) return own;
    ChannelStats common = own;
    common.min = allTimes.lo;
    common.max = allTimes.hi;
    return common;
}

TexelEncoding makeEncoding(const ChannelStats& stats, bool categorical, bool exact, bool prefiltered) {
    TexelEncoding encoding;
    encoding.coverage = stats.someAbsent;
    encoding.exact = exact;
    encoding.prefiltered = prefiltered && !categorical;
    const double range = stats.max > stats.min ? stats.max - stats.min : 1;
    if (categorical && range < 65535) {
        encoding.offset = stats.min;
        encoding.scale = 65535;
    } else if (exact) {
        encoding.offset = stats.min;
        encoding.scale = range;
    } else {
        encoding.offset = stats.min - range * (2.0 / 3);
        encoding.scale = range * (7.0 / 3);
    }
    return encoding;
}

glm::ivec3 levelTexels(const BrickGrid& grid, int level) {
    glm::ivec3 size = grid.levelSamples(level);
    if (grid.lattice.kind == LatticeKind::BCC) size.z = (((grid.lattice.size.z + 1) / 2) + (1 << level) - 1) >> level;
    return size;
}

namespace {

/// Consecutive output samples that come from one brick.
struct Run {
    int brick, begin, end;
};

struct Axis {
    std::vector<int> sample; ///< within its brick
    std::vector<Run> runs;
};

/// Where the output samples of one axis come from. `perTexel` samples per texel, the sublattices alternating.
Axis mapAxis(int begin, int end, int halo, int whole, int edge, int perTexel) {
    Axis axis;
    for (int i = (begin - halo) * perTexel; i < (end + halo) * perTexel; ++i) {
        const int parity = perTexel == 2 ? i & 1 : 0;
        const int count = perTexel == 2 ? (whole + 1 - parity) / 2 : whole;
        int at = perTexel == 2 ? (i - parity) / 2 : i;
        at = count > 0 ? glm::clamp(at, 0, count - 1) * perTexel + parity : 0;
        const int brick = at / (edge * perTexel);
        axis.sample.push_back(at % (edge * perTexel));
        const int index = int(axis.sample.size()) - 1;
        if (axis.runs.empty() || axis.runs.back().brick != brick) axis.runs.push_back({brick, index, index});
        axis.runs.back().end = index + 1;
    }
    return axis;
}

std::size_t linear(glm::ivec3 at, glm::ivec3 size) {
    return (std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) + std::size_t(at.x);
}

} // namespace

BrickSamples gatherBox(const BrickGrid& grid, const BrickKey& which, const TexelBox& box, int halo,
                       const ReadBrick& read) {
    const glm::ivec3 whole = grid.levelSamples(box.level);
    const int perTexel = grid.lattice.kind == LatticeKind::BCC ? 2 : 1, edge = grid.brickSize >> box.level;
    Axis axes[3];
    BrickSamples out;
    for (int a = 0; a < 3; ++a) {
        axes[a] = mapAxis(box.begin[a], box.end[a], halo, whole[a], edge, a == 2 ? perTexel : 1);
        out.size[a] = int(axes[a].sample.size());
    }
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    std::once_flag masked;
    const std::size_t nx = axes[0].runs.size(), ny = axes[1].runs.size(), nz = axes[2].runs.size();
    parallelFor(nx * ny * nz, [&](std::size_t i) {
        const Run &rx = axes[0].runs[i % nx], &ry = axes[1].runs[i / nx % ny], &rz = axes[2].runs[i / nx / ny];
        BrickKey key = which;
        key.level = box.level;
        key.index = {rx.brick, ry.brick, rz.brick};
        const SharedBrick from = read(key);
        if (!from->present.empty()) std::call_once(masked, [&] { out.present.assign(total, 1); });
        for (int z = rz.begin; z < rz.end; ++z)
            for (int y = ry.begin; y < ry.end; ++y) {
                const std::size_t to = linear({0, y, z}, out.size);
                const std::size_t source =
                    linear({0, axes[1].sample[std::size_t(y)], axes[2].sample[std::size_t(z)]}, from->size);
                for (int x = rx.begin; x < rx.end; ++x) {
                    const std::size_t sample = source + std::size_t(axes[0].sample[std::size_t(x)]);
                    out.values[to + std::size_t(x)] = from->values[sample];
                    if (!from->present.empty()) out.present[to + std::size_t(x)] = from->present[sample];
                }
            }
    });
    return out;
}

namespace {

/// Block ranges of packed texels: those of one texel more on every side belong to a block, since interpolation inside
/// it reaches them.
BlockRanges blockRanges(const std::vector<float>& row, glm::ivec3 size, int samples) {
    BlockRanges blocks;
    const glm::ivec3 texels = size - 2 * kHalo;
    blocks.count = (texels + kBlockTexels - 1) / kBlockTexels;
    const std::size_t total = std::size_t(blocks.count.x) * std::size_t(blocks.count.y) * std::size_t(blocks.count.z);
    blocks.min.assign(total, std::numeric_limits<float>::infinity());
    blocks.max.assign(total, -std::numeric_limits<float>::infinity());
    parallelFor(total, [&](std::size_t block) {
        const glm::ivec3 at(int(block % std::size_t(blocks.count.x)),
                            int(block / std::size_t(blocks.count.x) % std::size_t(blocks.count.y)),
                            int(block / std::size_t(blocks.count.x) / std::size_t(blocks.count.y)));
        const glm::ivec3 lo = at * kBlockTexels + kHalo - 1;
        const glm::ivec3 hi = glm::min(lo + kBlockTexels + 2, size);
        float least = blocks.min[block], most = blocks.max[block]; // NaN is neither
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y)
                for (std::size_t i = linear({lo.x, y, z}, size) * std::size_t(samples),
                                 end = linear({hi.x - 1, y, z}, size) * std::size_t(samples) + std::size_t(samples);
                     i < end; ++i) {
                    least = row[i] < least ? row[i] : least;
                    most = row[i] > most ? row[i] : most;
                }
        blocks.min[block] = least;
        blocks.max[block] = most;
    });
    return blocks;
}

} // namespace

TexelBlock makeTexels(const BrickGrid& grid, const BrickKey& which, const TexelBox& box, const TexelEncoding& encoding,
                      const ReadBrick& read) {
    BrickSamples samples = gatherBox(grid, which, box, encoding.prefiltered ? kHalo + 1 : kHalo, read);
    if (encoding.prefiltered) samples = volume::prefilter(samples, volume::levelGeometry(grid, box.level));

    TexelBlock out;
    const int perTexel = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    out.size = box.size() + 2 * kHalo;
    out.components = perTexel * (encoding.coverage ? 2 : 1);
    const std::size_t texels = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    (encoding.exact ? out.exact.resize(texels * std::size_t(out.components))
                    : out.normalised.resize(texels * std::size_t(out.components)));
    std::vector<float> plain(texels * std::size_t(perTexel)); // texel units, NaN = absent; for the block ranges
    const float offset = float(encoding.offset), inverse = float(1 / encoding.scale);
    parallelFor(std::size_t(out.size.z), [&](std::size_t z) {
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x) {
                const std::size_t texel = linear({x, y, int(z)}, out.size);
                for (int s = 0; s < perTexel; ++s) {
                    const std::size_t from = linear({x, y, int(z) * perTexel + s}, samples.size);
                    const bool present = samples.present.empty() || samples.present[from] != 0;
                    float value = (samples.values[from] - offset) * inverse;
                    if (!encoding.exact) value = glm::clamp(value, 0.0f, 1.0f);
                    plain[texel * std::size_t(perTexel) + std::size_t(s)] =
                        present ? value : std::numeric_limits<float>::quiet_NaN();
                    if (!present) value = 0;
                    const std::size_t to = texel * std::size_t(out.components) + std::size_t(s);
                    if (encoding.exact) {
                        out.exact[to] = value;
                        if (encoding.coverage) out.exact[to + std::size_t(perTexel)] = present;
                    } else {
                        out.normalised[to] = std::uint16_t(value * 65535.0f + 0.5f);
                        if (encoding.coverage) out.normalised[to + std::size_t(perTexel)] = present ? 65535 : 0;
                    }
                }
            }
    });
    out.blocks = blockRanges(plain, out.size, perTexel);
    out.blocks.level = box.level;
    return out;
}

} // namespace tessera::vis
