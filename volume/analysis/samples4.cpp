#include "volume/analysis/samples4.h"

#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace tessera::volume {

namespace {

/// 32-bit hash of a number (SplitMix64's finaliser).
std::uint32_t mixed(std::uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return std::uint32_t((x ^ x >> 31) >> 16);
}

double samplesAt(const BrickGrid& grid, int level) {
    const glm::dvec3 size(grid.levelSamples(level));
    return size.x * size.y * size.z;
}

int chooseLevel(const BrickGrid& grid, double times, double budget) {
    constexpr double kMost = 8; // most samples read per sample kept
    return grid.levelWithin(kMost * budget / times);
}

} // namespace

Samples4 gatherSamples(const BrickSource& source, const SamplesQuery& query, bool coarsest, const Progress& progress) {
    const BrickGrid& grid = source.grid();
    Samples4 all;
    all.channels = int(query.channels.size());
    all.level = coarsest ? grid.levels - 1 : chooseLevel(grid, double(query.times.size()), double(query.budget));
    const double total = samplesAt(grid, all.level) * double(query.times.size());
    const double keep = std::min(1.0, double(query.budget) / std::max(total, 1.0));
    all.skipped = 1 - keep;
    const auto threshold = std::uint32_t(std::min(keep * 4294967296.0, 4294967295.0));
    std::vector<std::uint32_t> order;
    const glm::ivec3 bricks = grid.count();
    const std::size_t perTime = std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z);
    std::uint64_t number = 0;
    std::vector<BrickSamples> read(query.channels.size());
    for (std::size_t t = 0; t < query.times.size(); ++t)
        for (std::size_t b = 0; b < perTime; ++b) {
            progress.advance((double(t) + double(b) / double(perTime)) / double(query.times.size()), "samples");
            BrickKey key{0, query.times[t], all.level, {}};
            key.index = {int(b % std::size_t(bricks.x)), int(b / std::size_t(bricks.x) % std::size_t(bricks.y)),
                         int(b / (std::size_t(bricks.x) * std::size_t(bricks.y)))};
            for (std::size_t c = 0; c < read.size(); ++c) {
                key.channel = query.channels[c];
                read[c] = source.read(key);
            }
            const auto time = float(source.info().times[std::size_t(query.times[t])]);
            SamplePositions positions(grid, key.index, all.level);
            const std::size_t count = read.empty() ? 0 : read.front().values.size();
            for (std::size_t i = 0; i < count; ++i, positions.next()) {
                const std::uint32_t hash = mixed(++number * 0x9e3779b97f4a7c15ull);
                const bool present = read.front().isPresent(i);
                if (!present || hash > threshold || std::isnan(read.front().values[i])) continue;
                order.push_back(hash);
                all.positions.emplace_back(positions.at());
                all.times.push_back(time);
                for (const BrickSamples& channel : read)
                    all.values.push_back(channel.isPresent(i) ? channel.values[i]
                                                              : std::numeric_limits<float>::quiet_NaN());
            }
        }
    // Sorted by hash, so that neighbours in the data are far apart in the list.
    std::vector<std::uint32_t> index(order.size());
    std::iota(index.begin(), index.end(), 0u);
    std::sort(index.begin(), index.end(),
              [&](std::uint32_t a, std::uint32_t b) { return order[a] != order[b] ? order[a] < order[b] : a < b; });
    Samples4 out = all;
    const auto channels = std::size_t(all.channels);
    for (std::size_t i = 0; i < index.size(); ++i) {
        out.positions[i] = all.positions[index[i]];
        out.times[i] = all.times[index[i]];
        std::copy_n(&all.values[index[i] * channels], channels, &out.values[i * channels]);
    }
    progress.advance(1, "samples");
    return out;
}

} // namespace tessera::volume
