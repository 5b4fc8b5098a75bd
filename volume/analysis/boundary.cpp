#include "volume/analysis/boundary.h"

#include "volume/analysis/boundary_derivatives.h"
#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/derived/stencil.h"
#include "volume/reconstruct/continued.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace tessera::volume {

namespace {

constexpr double kNoMean = std::numeric_limits<double>::quiet_NaN();

/// An empty histogram for a query.
DerivativeHistogram emptyHistogram(const BrickSource& source, const DerivativeQuery& query) {
    DerivativeHistogram out;
    out.valueBins = query.valueBins;
    out.gradientBins = query.gradientBins;
    const DatasetInfo& info = source.info();
    out.range = query.range.hi != query.range.lo ? query.range : info.channelRange(info.channel(query.channel));
    out.gradientTop = query.gradientTop > 0 ? query.gradientTop : std::abs(out.range.hi - out.range.lo) / 4;
    const auto values = static_cast<std::size_t>(query.valueBins);
    out.count.resize(values * static_cast<std::size_t>(query.gradientBins));
    out.second.resize(out.count.size());
    out.first.resize(values);
    return out;
}

/// Counts one sample; values outside the range do not count.
void add(DerivativeHistogram& to, const Derivatives& at) {
    const double x = (at.value - to.range.lo) / (to.range.hi - to.range.lo);
    if (!(x >= 0 && x <= 1)) return;
    const auto v = static_cast<std::size_t>(std::min(x * to.valueBins, to.valueBins - 1.0));
    const auto g =
        static_cast<std::size_t>(std::min(at.first / to.gradientTop * to.gradientBins, to.gradientBins - 1.0));
    const std::size_t bin = g * static_cast<std::size_t>(to.valueBins) + v;
    ++to.count[bin];
    to.second[bin] += at.second;
    to.first[v] += at.first;
    ++to.samples;
}

/// A brick with a border, and the parts of its samples; no parts: all in one.
struct Surrounded {
    BrickSamples samples;
    int halo = 1; ///< of each sublattice
    std::vector<std::uint8_t> parts;
};

/// Counts the samples of one brick that have all neighbours; neighbours in other parts are extrapolated from its own
/// part.
void addBrick(DerivativeHistogram& to, const BrickGrid& grid, const BrickKey& key, const Surrounded& brick) {
    const LatticeKind kind = grid.lattice.kind;
    const glm::ivec3 slices(1, 1, kind == LatticeKind::BCC ? 2 : 1);
    const glm::ivec3 begin = grid.begin(key.index), first = begin - brick.halo * slices;
    const BrickView view{brick.samples, kind, first};
    const auto partOf = [&](glm::ivec3 at) {
        const glm::ivec3 size = brick.samples.size, in = clampToLattice(kind, size, at - first);
        return int(brick.parts[(std::size_t(in.z) * std::size_t(size.y) + std::size_t(in.y)) * std::size_t(size.x) +
                               std::size_t(in.x)]);
    };
    const glm::ivec3 lo = glm::max(begin, slices), hi = glm::min(grid.end(key.index), grid.lattice.size - slices);
    Derivatives at;
    for (int z = lo.z; z < hi.z; ++z)
        for (int y = lo.y; y < hi.y; ++y)
            for (int x = lo.x; x < hi.x; ++x) {
                const glm::ivec3 here(x, y, z);
                if (brick.parts.empty()) {
                    if (derivativesAt(kind, view, here, at)) add(to, at);
                    continue;
                }
                const OwnPart own(kind, grid.lattice.size, view, partOf, here);
                const auto continuedOwn = [&](glm::ivec3 there) {
                    const Sample sample = view(there);
                    return sample.present ? own(there) : sample;
                };
                if (derivativesAt(kind, continuedOwn, here, at)) add(to, at);
            }
}

/// The brick with the border that its derivatives need.
Surrounded surrounded(const BrickGrid& grid, BrickKey key, const ReadSamples& read,
                      const std::optional<PartLabel>& label) {
    if (!label) return {gather(grid, key, 1, read), 1, {}};
    Surrounded out{gather(grid, key, kOwnPartReach, read), kOwnPartReach, {}};
    key.channel = label->channel;
    out.parts = partsOfSamples(gather(grid, key, kOwnPartReach, read), label->parts);
    if (std::ranges::adjacent_find(out.parts, std::not_equal_to<>()) == out.parts.end()) out.parts.clear();
    return out;
}

} // namespace

DerivativeHistogram derivativeHistogram(const BrickSource& source, const DerivativeQuery& query,
                                        const Progress& progress) {
    const BrickGrid& grid = source.grid();
    const glm::ivec3 bricks = grid.count();
    DerivativeHistogram out = emptyHistogram(source, query);
    const std::optional<PartLabel> label = partLabel(source.info(), query.channel);
    std::vector<DerivativeHistogram> slabs(static_cast<std::size_t>(bricks.z), out);
    std::atomic<int> done = 0;
    parallelFor(slabs.size(), [&](std::size_t z) {
        // A slab reads bricks of neighbouring slabs too: the cache decodes each once per slab.
        std::map<std::array<int, 4>, BrickSamples> read;
        const auto once = [&](const BrickKey& key) {
            const auto [entry, added] = read.try_emplace({key.index.x, key.index.y, key.index.z, key.channel});
            if (added) entry->second = source.read(key);
            return entry->second;
        };
        for (int y = 0; y < bricks.y; ++y) {
            for (int x = 0; x < bricks.x; ++x) {
                const BrickKey key{query.channel, query.time, 0, {x, y, static_cast<int>(z)}};
                if (source.stats(key).presentFraction > 0)
                    addBrick(slabs[z], grid, key, surrounded(grid, key, once, label));
            }
            std::erase_if(read, [&](const auto& entry) { return entry.first[1] < y; });
        }
        progress.advance(double(++done) / double(slabs.size()), "derivatives");
    });
    for (const DerivativeHistogram& slab : slabs) { // in order, so that sums are reproducible
        for (std::size_t i = 0; i < out.count.size(); ++i) {
            out.count[i] += slab.count[i];
            out.second[i] += slab.second[i];
        }
        for (std::size_t i = 0; i < out.first.size(); ++i) out.first[i] += slab.first[i];
        out.samples += slab.samples;
    }
    return out;
}

BoundaryCurves boundaryCurves(const DerivativeHistogram& histogram, double threshold) {
    BoundaryCurves out;
    out.range = histogram.range;
    const auto values = static_cast<std::size_t>(histogram.valueBins);
    double mostFirst = 0, mostSecond = 0;
    for (std::size_t v = 0; v < values; ++v) {
        double count = 0, second = 0;
        for (std::size_t bin = v; bin < histogram.count.size(); bin += values) {
            count += double(histogram.count[bin]);
            second += histogram.second[bin];
        }
        out.first.push_back(count > 0 ? histogram.first[v] / count : kNoMean);
        out.second.push_back(count > 0 ? second / count : kNoMean);
        if (count > 0) {
            mostFirst = std::max(mostFirst, out.first[v]);
            mostSecond = std::max(mostSecond, out.second[v]);
        }
    }
    if (mostSecond > 0) out.thickness = mostFirst / (std::exp(0.5) * mostSecond);
    const double least = threshold * mostFirst, squared = out.thickness * out.thickness;
    for (std::size_t v = 0; v < values; ++v) {
        const double above = out.first[v] - least;
        out.distance.push_back(above > 0 ? -squared * out.second[v] / above : kNoMean);
    }
    return out;
}

} // namespace tessera::volume
