#include "vis/bricks/texels.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/sources/centred_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
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
    const double width = allTimes.hi - allTimes.lo;
    const auto within = [&](double share) {
        return own.min >= allTimes.lo - (share + kRounding) * width &&
               own.max <= allTimes.hi + (share + kRounding) * width;
    };
    if (own.allAbsent || !(own.max - own.min >= kFairShare * width) || !within(volume::kCentredHeadroom)) return own;
    const double beyond = within(0) ? 0 : volume::kCentredHeadroom * width;
    ChannelStats common = own;
    common.min = allTimes.lo - beyond;
    common.max = allTimes.hi + beyond;
    return common;
}

TexelEncoding makeEncoding(const ChannelStats& stats, bool categorical, bool exact, volume::Prefilter prefilter) {
    TexelEncoding encoding;
    encoding.coverage = stats.someAbsent;
    encoding.exact = exact;
    encoding.prefilter = categorical ? volume::Prefilter::None : prefilter;
    const double range = stats.max > stats.min ? stats.max - stats.min : 1;
    if (categorical && range < 65535) {
        encoding.offset = stats.min;
        encoding.scale = 65535;
    } else if (exact) {
        encoding.offset = stats.min;
        encoding.scale = range;
    } else {
        const double headroom =
            volume::prefilterOvershoot(prefilter == volume::Prefilter::None ? volume::Prefilter::Linear : prefilter);
        encoding.offset = stats.min - range * headroom;
        encoding.scale = range * (1 + 2 * headroom);
    }
    return encoding;
}

glm::ivec3 levelTexels(const BrickGrid& grid, int level) {
    glm::ivec3 size = grid.levelSamples(level);
    if (grid.lattice.kind == LatticeKind::BCC) size.z = (((grid.lattice.size.z + 1) / 2) + (1 << level) - 1) >> level;
    return size;
}

namespace {

/// Consecutive output samples from one brick.
struct Run {
    int brick, begin, end;
};

struct Axis {
    std::vector<int> sample; ///< index within its brick
    std::vector<Run> runs;
    /// Number of samples from `begin` on that are adjacent in the brick.
    int adjacent(int begin, int end) const {
        int last = begin + 1;
        while (last < end && sample[std::size_t(last)] == sample[std::size_t(last) - 1] + 1) ++last;
        return last - begin;
    }
};

/// Sources of the output samples along one axis. `perTexel`: samples per texel, with the sublattices alternating.
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

std::size_t indexOfTexel(glm::ivec3 at, glm::ivec3 size) {
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
                const std::size_t to = indexOfTexel({0, y, z}, out.size);
                const std::size_t source =
                    indexOfTexel({0, axes[1].sample[std::size_t(y)], axes[2].sample[std::size_t(z)]}, from->size);
                for (int x = rx.begin, count = 0; x < rx.end; x += count) { // samples beyond the lattice individually
                    count = axes[0].adjacent(x, rx.end);
                    const std::size_t sample = source + std::size_t(axes[0].sample[std::size_t(x)]);
                    std::copy_n(&from->values[sample], count, &out.values[to + std::size_t(x)]);
                    if (!from->present.empty())
                        std::copy_n(&from->present[sample], count, &out.present[to + std::size_t(x)]);
                }
            }
    });
    return out;
}

namespace {

struct Extent {
    float least = std::numeric_limits<float>::infinity(), most = -std::numeric_limits<float>::infinity();
    void take(float low, float high) { // a NaN changes neither bound
        least = low < least ? low : least;
        most = high > most ? high : most;
    }
};

/// Texel ranges per block from rows of texels. A block includes the texels beyond each side that interpolation inside
/// it reads: one, of a cubic kernel two.
struct RowRanges {
    glm::ivec3 size; ///< texels with halo
    int beyond;      ///< at most kHalo
    int blocks;      ///< per row
    std::vector<float> min, max;

    RowRanges(glm::ivec3 of, volume::Prefilter prefilter)
        : size(of), beyond(prefilter == volume::Prefilter::Cubic ? 2 : 1),
          blocks((of.x - 2 * kHalo + kBlockTexels - 1) / kBlockTexels) {
        const std::size_t total = std::size_t(blocks) * std::size_t(size.y) * std::size_t(size.z);
        min.resize(total);
        max.resize(total);
    }
    /// `texels`: one row, with `samples` values per texel.
    void take(std::size_t row, const float* texels, int samples) {
        for (int x = 0; x < blocks; ++x) {
            const int lo = x * kBlockTexels + kHalo - beyond, hi = std::min(lo + kBlockTexels + 2 * beyond, size.x);
            Extent extent;
            for (int n = lo * samples; n < hi * samples; ++n) extent.take(texels[n], texels[n]);
            min[row * std::size_t(blocks) + std::size_t(x)] = extent.least;
            max[row * std::size_t(blocks) + std::size_t(x)] = extent.most;
        }
    }
};

BlockRanges blockRanges(const RowRanges& rows, int level) {
    BlockRanges blocks;
    blocks.level = level;
    blocks.count = (rows.size - 2 * kHalo + kBlockTexels - 1) / kBlockTexels;
    const std::size_t across = std::size_t(blocks.count.x),
                      total = across * std::size_t(blocks.count.y) * std::size_t(blocks.count.z);
    blocks.min.resize(total);
    blocks.max.resize(total);
    parallelFor(std::size_t(blocks.count.y) * std::size_t(blocks.count.z), [&](std::size_t i) {
        const glm::ivec2 lo =
            glm::ivec2(int(i) % blocks.count.y, int(i) / blocks.count.y) * kBlockTexels + (kHalo - rows.beyond);
        const glm::ivec2 hi = glm::min(lo + (kBlockTexels + 2 * rows.beyond), glm::ivec2(rows.size.y, rows.size.z));
        for (std::size_t x = 0; x < across; ++x) {
            Extent extent;
            for (int z = lo.y; z < hi.y; ++z)
                for (int y = lo.x; y < hi.x; ++y) {
                    const std::size_t from = (std::size_t(z) * std::size_t(rows.size.y) + std::size_t(y)) * across + x;
                    extent.take(rows.min[from], rows.max[from]);
                }
            blocks.min[i * across + x] = extent.least;
            blocks.max[i * across + x] = extent.most;
        }
    });
    return blocks;
}

/// Packs one row of a sublattice, starting at `first`, into component `sublattice` of the texels of `row`; writes the
/// unpacked values, NaN where absent, to `plain`.
void packRow(const BrickSamples& samples, std::size_t first, const TexelEncoding& encoding, int perTexel,
             int sublattice, std::size_t row, std::vector<float>& plain, TexelBlock& out) {
    const std::size_t width = std::size_t(out.size.x);
    const float offset = float(encoding.offset), inverse = float(1 / encoding.scale);
    const float* from = &samples.values[first];
    const std::uint8_t* present = samples.present.empty() ? nullptr : &samples.present[first];
    float* texels = &plain[std::size_t(sublattice)];
    const auto every = std::size_t(perTexel), components = std::size_t(out.components);
    for (std::size_t x = 0; x < width; ++x) {
        const float value = (from[x] - offset) * inverse;
        texels[x * every] = encoding.exact ? value : glm::clamp(value, 0.0f, 1.0f);
    }
    const std::size_t to = row * width * components + std::size_t(sublattice);
    for (std::size_t x = 0; x < width; ++x) {
        if (encoding.exact)
            out.exact[to + x * components] = texels[x * every];
        else
            out.normalised[to + x * components] = std::uint16_t(texels[x * every] * 65535.0f + 0.5f);
    }
    if (present == nullptr && !encoding.coverage) return;
    for (std::size_t x = 0; x < width; ++x) {
        const bool is = present == nullptr || present[x] != 0;
        const std::size_t value = to + x * components, coverage = value + every;
        if (!is) texels[x * every] = std::numeric_limits<float>::quiet_NaN();
        if (encoding.exact) {
            if (!is) out.exact[value] = 0;
            if (encoding.coverage) out.exact[coverage] = is;
        } else {
            if (!is) out.normalised[value] = 0;
            if (encoding.coverage) out.normalised[coverage] = is ? 65535 : 0;
        }
    }
}

} // namespace

TexelBlock makeTexels(const BrickGrid& grid, const BrickKey& which, const TexelBox& box, const TexelEncoding& encoding,
                      const ReadBrick& read) {
    TexelBlock out;
    const int perTexel = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    out.size = box.size() + 2 * kHalo;
    out.components = perTexel * (encoding.coverage ? 2 : 1);
    const std::size_t texels = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    (encoding.exact ? out.exact.resize(texels * std::size_t(out.components))
                    : out.normalised.resize(texels * std::size_t(out.components)));
    RowRanges ranges(out.size, encoding.prefilter);
    // Layer by layer, to keep the intermediate buffer small.
    const int layer = grid.brickSize;
    for (int z = box.begin.z; z < box.end.z; z += layer) {
        const TexelBox part{
            box.level, {box.begin.x, box.begin.y, z}, {box.end.x, box.end.y, std::min(z + layer, box.end.z)}};
        const volume::LevelGeometry geometry = volume::levelGeometry(grid, box.level);
        const int reach = volume::prefilterReach(encoding.prefilter, geometry);
        BrickSamples samples = gatherBox(grid, which, part, kHalo + reach, read);
        if (reach > 0) samples = volume::prefiltered(samples, geometry, encoding.prefilter);
        const int below = z - box.begin.z, first = z == box.begin.z ? 0 : below + kHalo,
                  last = part.end.z == box.end.z ? out.size.z : part.end.z - box.begin.z + kHalo;
        const auto rows = std::size_t(out.size.y);
        parallelRanges(rows * std::size_t(last - first), [&](std::size_t begin, std::size_t end) {
            std::vector<float> plain(std::size_t(out.size.x) * std::size_t(perTexel));
            for (std::size_t row = begin + rows * std::size_t(first); row < end + rows * std::size_t(first); ++row) {
                const glm::ivec3 from(0, int(row % rows), (int(row / rows) - below) * perTexel);
                for (int s = 0; s < perTexel; ++s)
                    packRow(samples, indexOfTexel(from + glm::ivec3(0, 0, s), samples.size), encoding, perTexel, s, row,
                            plain, out);
                ranges.take(row, plain.data(), perTexel);
            }
        });
    }
    out.blocks = blockRanges(ranges, box.level);
    return out;
}

} // namespace tessera::vis
