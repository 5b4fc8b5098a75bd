#include "volume/analysis/extremes.h"

#include "volume/bricks/brick_columns.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

namespace {

constexpr std::size_t kBricksTogether = 16;

/// A brick and the furthest value that it may hold, with the sign of the search: greater is better.
struct BoundedBrick {
    glm::ivec3 index{0};
    double bound = 0;
};

std::vector<BoundedBrick> boundedBricks(const BrickSource& source, const ExtremeQuery& query, int time) {
    std::vector<BoundedBrick> bricks;
    for (const glm::ivec3 index : allBricks(source.grid())) {
        const BrickStats stats = source.stats({query.channel, time, 0, index});
        if (!(stats.presentFraction > 0)) continue;
        constexpr float kMost = std::numeric_limits<float>::infinity(); // samples may lie half a step of floats beyond
        bricks.push_back({index, query.greatest ? double(std::nextafter(stats.max, kMost))
                                                : -double(std::nextafter(stats.min, -kMost))});
    }
    std::ranges::stable_sort(bricks, std::greater(), &BoundedBrick::bound);
    return bricks;
}

/// The best sample of one brick.
std::optional<Extreme> bestOfBrick(const BrickSource& source, const ExtremeQuery& query, int time, glm::ivec3 index) {
    const BrickGrid& grid = source.grid();
    const std::vector<double> values = brickColumn(source, query.channel, time, index);
    const std::vector<double> label = brickColumn(source, query.label, time, index);
    const auto brushed = brickColumns(source, query.doiChannels, time, index);
    std::vector<float> asked(brushed.size());
    std::optional<Extreme> best;
    forSamples(grid, index, 0, [&](std::size_t i, glm::ivec3 at) {
        if (!std::isfinite(values[i])) return;
        if (best && (query.greatest ? values[i] <= best->value : values[i] >= best->value)) return;
        if (query.label >= 0 && !(std::abs(label[i] - query.region) < 0.5)) return;
        const glm::dvec3 position = samplePosition(grid, at, 0);
        if (query.doi) {
            for (std::size_t c = 0; c < brushed.size(); ++c) asked[c] = float(brushed[c][i]);
            if (!(query.doi(asked, position) >= 0.5)) return;
        }
        best = Extreme{values[i], position, time};
    });
    return best;
}

} // namespace

std::optional<Extreme> findExtreme(const BrickSource& source, const ExtremeQuery& query, const Progress& progress) {
    std::optional<Extreme> best;
    const double sign = query.greatest ? 1 : -1;
    for (std::size_t t = 0; t < query.times.size(); ++t) {
        const std::vector<BoundedBrick> bricks = boundedBricks(source, query, query.times[t]);
        for (std::size_t first = 0; first < bricks.size(); first += kBricksTogether) {
            progress.advance((double(t) + double(first) / double(bricks.size())) / double(query.times.size()),
                             "extreme value");
            if (progress.stop.stop_requested()) throw Cancelled();
            if (best && bricks[first].bound <= sign * best->value) break;
            const std::size_t count = std::min(kBricksTogether, bricks.size() - first);
            std::vector<std::optional<Extreme>> found(count);
            parallelFor(count, [&](std::size_t i) {
                found[i] = bestOfBrick(source, query, query.times[t], bricks[first + i].index);
            });
            for (const std::optional<Extreme>& each : found)
                if (each && (!best || sign * each->value > sign * best->value)) best = each;
        }
    }
    return best;
}

} // namespace tessera::volume
