#pragma once

#include "volume/base/parallel.h"
#include "volume/bricks/brick_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace tessera::volume {

/// Samples of one channel of a brick, NaN where absent; of channel -1 none.
inline std::vector<double> brickColumn(const BrickSource& source, int channel, int time, glm::ivec3 brick,
                                       int level = 0) {
    if (channel < 0) return {};
    const BrickSamples samples = source.read({channel, time, level, brick});
    std::vector<double> column(samples.values.size());
    for (std::size_t i = 0; i < column.size(); ++i)
        column[i] = samples.isPresent(i) ? samples.exact(i) : std::numeric_limits<double>::quiet_NaN();
    return column;
}

inline std::vector<std::vector<double>> brickColumns(const BrickSource& source, std::span<const int> channels, int time,
                                                     glm::ivec3 brick, int level = 0) {
    std::vector<std::vector<double>> columns;
    for (const int channel : channels) columns.push_back(brickColumn(source, channel, time, brick, level));
    return columns;
}

/// Calls body(index in the brick, storage index of the lattice at the level) for each sample in storage order.
inline void forSamples(const BrickGrid& grid, glm::ivec3 brick, int level, auto&& body) {
    const glm::ivec3 first = grid.levelBegin(brick, level), size = grid.brickSamples(brick, level);
    std::size_t i = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) body(i++, first + glm::ivec3(x, y, z));
}

/// Bricks in order, x fastest.
inline std::vector<glm::ivec3> allBricks(const BrickGrid& grid) {
    std::vector<glm::ivec3> bricks;
    const glm::ivec3 count = grid.count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) bricks.emplace_back(x, y, z);
    return bricks;
}

/// Position of a label value in `regions`, -1 where it is in none; without regions everything is in the first.
inline int regionOf(std::span<const int> regions, double label) {
    if (regions.empty()) return 0;
    if (!(std::abs(label) < 2e9)) return -1;
    const auto value = int(std::lround(label));
    for (std::size_t r = 0; r < regions.size(); ++r)
        if (regions[r] == value) return int(r);
    return -1;
}

/// Computes `of(brick)` for all bricks, several at a time, and gives each result to `take` in order: sums are the same
/// on any number of threads.
template <class Of, class Take>
void inBrickOrder(const std::vector<glm::ivec3>& bricks, const Of& of, const Take& take,
                  const std::function<void(double)>& advance) {
    constexpr std::size_t kTogether = 64;
    using Result = decltype(of(bricks.front()));
    for (std::size_t first = 0; first < bricks.size(); first += kTogether) {
        advance(double(first) / double(bricks.size()));
        const std::size_t count = std::min(kTogether, bricks.size() - first);
        std::vector<Result> results(count);
        parallelFor(count, [&](std::size_t i) { results[i] = of(bricks[first + i]); });
        for (const Result& result : results) take(result);
    }
    advance(1);
}

} // namespace tessera::volume
