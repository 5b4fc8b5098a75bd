#include "volume/analysis/samples4.h"

#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

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

constexpr double kFirstBricks = 128; // of the coarsest step, over all its times and channels
constexpr double kFirstTimes = 2;
constexpr double kRefined = 4; // by how much each step reads more

/// `count` of the numbers 0 .. size - 1, evenly spread, the first and the last among them.
std::vector<int> spreadTimes(std::size_t size, std::size_t count) {
    std::vector<int> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(count > 1 ? int(i * (size - 1) / (count - 1)) : 0);
    return out;
}

/// The bricks of a step: all, or those with the least hashes, in ascending order.
std::vector<std::size_t> bricksOfStep(std::size_t all, std::size_t wanted) {
    std::vector<std::size_t> out(all);
    std::iota(out.begin(), out.end(), std::size_t(0));
    if (wanted >= all) return out;
    const auto order = [](std::size_t a, std::size_t b) {
        const std::uint32_t first = mixed(a * 0x9e3779b97f4a7c15ull), second = mixed(b * 0x9e3779b97f4a7c15ull);
        return first != second ? first < second : a < b;
    };
    std::nth_element(out.begin(), out.begin() + std::ptrdiff_t(wanted), out.end(), order);
    out.resize(wanted);
    std::sort(out.begin(), out.end());
    return out;
}

/// All samples of one channel at one level and time, NaN where absent, in the storage order of the level.
class LevelValues {
public:
    LevelValues(const BrickSource& source, BrickKey key) : size_(source.grid().levelSamples(key.level)) {
        const BrickGrid& grid = source.grid();
        values_.resize(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z));
        for (std::size_t b = 0; b < grid.brickCount(); ++b) {
            key.index = grid.indexOf(b);
            const BrickSamples brick = source.read(key);
            const glm::ivec3 begin = grid.levelBegin(key.index, key.level);
            std::size_t i = 0;
            for (int z = 0; z < brick.size.z; ++z)
                for (int y = 0; y < brick.size.y; ++y)
                    for (int x = 0; x < brick.size.x; ++x, ++i)
                        values_[index(begin + glm::ivec3(x, y, z))] =
                            brick.isPresent(i) ? brick.values[i] : std::numeric_limits<float>::quiet_NaN();
        }
    }
    /// NaN outside, too.
    float at(glm::ivec3 place) const {
        if (glm::any(glm::lessThan(place, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(place, size_)))
            return std::numeric_limits<float>::quiet_NaN();
        return values_[index(place)];
    }

private:
    std::size_t index(glm::ivec3 at) const {
        return (std::size_t(at.z) * std::size_t(size_.y) + std::size_t(at.y)) * std::size_t(size_.x) +
               std::size_t(at.x);
    }
    glm::ivec3 size_;
    std::vector<float> values_;
};

/// A value with what lies before and behind it along an axis; `before` and `behind` are distances.
float slopeAt(float low, float here, float high, double before, double behind) {
    const bool hasLow = !std::isnan(low) && before > 0, hasHigh = !std::isnan(high) && behind > 0;
    if (hasLow && hasHigh) return float((double(high) - double(low)) / (before + behind));
    if (hasLow) return float((double(here) - double(low)) / before);
    return hasHigh ? float((double(high) - double(here)) / behind) : 0.0f;
}

/// Gradients in space and time of a channel at a level; keeps the values of three times.
class Gradients4 {
public:
    Gradients4(const BrickSource& source, int channel, int level) : source_(source), key_{channel, 0, level, {}} {}

    void goTo(int time) {
        std::erase_if(kept_, [&](const auto& own) { return std::abs(own.first - time) > 1; });
        const std::vector<double>& times = source_.info().times;
        for (int t = std::max(0, time - 1); t <= std::min(time + 1, int(times.size()) - 1); ++t)
            if (!kept_.contains(t)) {
                key_.time = t;
                kept_.emplace(t, LevelValues(source_, key_));
            }
        time_ = time;
    }

    glm::vec4 at(glm::ivec3 place) const {
        const Lattice& lattice = source_.grid().lattice;
        const LevelValues& now = kept_.at(time_);
        const float here = now.at(place);
        glm::vec4 out(0);
        for (int axis = 0; axis < 3; ++axis) {
            const double cell = lattice.spacing[axis] * double(1 << key_.level);
            glm::ivec3 step(0);
            step[axis] = axis == 2 && lattice.kind == LatticeKind::BCC ? 2 : 1;
            out[axis] = slopeAt(now.at(place - step), here, now.at(place + step), cell, cell);
        }
        const std::vector<double>& times = source_.info().times;
        const auto beside = [&](int t) {
            const auto found = kept_.find(t);
            return found == kept_.end() ? std::numeric_limits<float>::quiet_NaN() : found->second.at(place);
        };
        const auto time = std::size_t(time_);
        const double before = time > 0 ? times[time] - times[time - 1] : 0;
        const double behind = time + 1 < times.size() ? times[time + 1] - times[time] : 0;
        out.w = slopeAt(beside(time_ - 1), here, beside(time_ + 1), before, behind);
        return out;
    }

private:
    const BrickSource& source_;
    BrickKey key_;
    std::map<int, LevelValues> kept_;
    int time_ = 0;
};

/// Brings samples into the order of their hashes, so that neighbours in the data are far apart in the list.
Samples4 inHashOrder(const Samples4& all, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> index(order.size());
    std::iota(index.begin(), index.end(), 0u);
    std::sort(index.begin(), index.end(),
              [&](std::uint32_t a, std::uint32_t b) { return order[a] != order[b] ? order[a] < order[b] : a < b; });
    Samples4 out = all;
    const auto channels = std::size_t(all.channels);
    for (std::size_t i = 0; i < index.size(); ++i) {
        out.positions[i] = all.positions[index[i]];
        out.times[i] = all.times[index[i]];
        if (!all.gradients.empty()) out.gradients[i] = all.gradients[index[i]];
        std::copy_n(&all.values[index[i] * channels], channels, &out.values[i * channels]);
    }
    return out;
}

} // namespace

int coarseSteps(const BrickGrid& grid, const SamplesQuery& query) {
    const double times = double(query.times.size());
    const double reads = times * double(grid.brickCount()) * double(std::max<std::size_t>(query.channels.size(), 1));
    int steps = 1;
    for (double bricks = kFirstBricks; bricks < reads; ++steps) bricks *= kRefined;
    return steps;
}

SampleStep sampleStep(const BrickGrid& grid, const SamplesQuery& query, int step) {
    SampleStep out;
    const std::size_t all = grid.brickCount(), times = query.times.size();
    std::size_t shown = times;
    out.bricks = all;
    if (step > 0) {
        out.level = grid.levels - 1;
        const double more = std::pow(kRefined, std::max(0, coarseSteps(grid, query) - step));
        const double reads = kFirstBricks * more / double(std::max<std::size_t>(query.channels.size(), 1));
        const double least = std::min(double(times), kFirstTimes * more);
        shown = std::size_t(std::clamp(std::floor(reads / double(all)), least, double(times)));
        out.bricks =
            std::size_t(std::clamp(std::ceil(reads / double(std::max<std::size_t>(shown, 1))), 1.0, double(all)));
    } else {
        out.level = chooseLevel(grid, double(times), double(query.budget));
    }
    for (const int t : spreadTimes(times, shown)) out.times.push_back(query.times[std::size_t(t)]);
    return out;
}

Samples4 gatherSamples(const BrickSource& source, const SamplesQuery& query, int step, const Progress& progress) {
    const BrickGrid& grid = source.grid();
    const SampleStep read = sampleStep(grid, query, step);
    const std::vector<std::size_t> bricks = bricksOfStep(grid.brickCount(), read.bricks);
    const bool half = query.lattice == SampleLattice::D4, bcc = grid.lattice.kind == LatticeKind::BCC;
    const auto isOfD4 = [&](glm::ivec3 place, int time) {
        return ((bcc ? place.z : place.x + place.y + place.z) + time) % 2 == 0;
    };
    Samples4 all;
    all.channels = int(query.channels.size());
    all.level = read.level;
    all.timesRead = int(read.times.size());
    double chosen = 0; // of one time
    for (const std::size_t b : bricks) {
        const glm::dvec3 size(grid.brickSamples(grid.indexOf(b), read.level));
        chosen += size.x * size.y * size.z * (half ? 0.5 : 1.0);
    }
    chosen *= double(read.times.size());
    const double keep = std::min(1.0, double(query.budget) / std::max(chosen, 1.0));
    const double level = samplesAt(grid, read.level) * double(read.times.size());
    all.skipped = 1 - keep * chosen / std::max(level, 1.0);
    all.share = keep * chosen / std::max(samplesAt(grid, 0) * double(query.times.size()), 1.0);
    const auto threshold = std::uint32_t(std::min(keep * 4294967296.0, 4294967295.0));
    std::optional<Gradients4> gradients;
    if (query.gradients && step == 0) gradients.emplace(source, query.gradientOf, read.level);
    std::vector<std::uint32_t> order;
    std::uint64_t number = 0;
    std::vector<BrickSamples> samples(query.channels.size());
    for (std::size_t t = 0; t < read.times.size(); ++t) {
        if (gradients) gradients->goTo(read.times[t]);
        for (std::size_t b = 0; b < bricks.size(); ++b) {
            progress.advance((double(t) + double(b) / double(bricks.size())) / double(read.times.size()), "samples");
            BrickKey key{0, read.times[t], read.level, grid.indexOf(bricks[b])};
            for (std::size_t c = 0; c < samples.size(); ++c) {
                key.channel = query.channels[c];
                samples[c] = source.read(key);
            }
            const auto time = float(source.info().times[std::size_t(read.times[t])]);
            SamplePositions positions(grid, key.index, read.level);
            const std::size_t count = samples.empty() ? 0 : samples.front().values.size();
            for (std::size_t i = 0; i < count; ++i, positions.next()) {
                const std::uint32_t hash = mixed(++number * 0x9e3779b97f4a7c15ull);
                const glm::ivec3 place = positions.index();
                if (half && !isOfD4(place, read.times[t])) continue;
                const bool present = samples.front().isPresent(i);
                if (!present || hash > threshold || std::isnan(samples.front().values[i])) continue;
                order.push_back(hash);
                all.positions.emplace_back(positions.at());
                all.times.push_back(time);
                if (gradients) all.gradients.push_back(gradients->at(place));
                for (const BrickSamples& channel : samples)
                    all.values.push_back(channel.isPresent(i) ? channel.values[i]
                                                              : std::numeric_limits<float>::quiet_NaN());
            }
        }
    }
    Samples4 out = inHashOrder(all, order);
    progress.advance(1, "samples");
    return out;
}

} // namespace tessera::volume
