#include "tests/volume/fields.h"
#include "volume/analysis/statistics.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

/// A source that knows the distribution of its bricks, and is not read.
class NotedSource final : public BrickSource {
public:
    NotedSource(std::shared_ptr<const BrickSource> source, int bins, double step)
        : source_(std::move(source)), bins_(bins), step_(step) {}
    const DatasetInfo& info() const override { return source_->info(); }
    const BrickGrid& grid() const override { return source_->grid(); }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(key); }
    BrickSamples read(const BrickKey&) const override { throw std::logic_error("a sample was read"); }
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        if (key.index == unknown) return std::nullopt;
        const BrickSamples brick = source_->read({key.channel, key.time, 0, key.index});
        std::vector<double> values;
        for (std::size_t i = 0; i < brick.values.size(); ++i)
            if (brick.isPresent(i)) values.push_back(double(brick.values[i]));
        BrickDistribution out;
        out.samples = values.size();
        out.step = step_;
        if (values.empty()) return out;
        const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
        out.range = {*lo, *hi};
        out.counts.assign(*lo < *hi ? std::size_t(bins_) : 1, 0);
        for (const double value : values) {
            out.mean += value / double(values.size());
            ++out.counts[binOf(out, value)];
        }
        return out;
    }
    static std::size_t binOf(const BrickDistribution& brick, double value) {
        const double extent = brick.range.hi - brick.range.lo, bins = double(brick.counts.size());
        const double place = extent > 0 ? std::max((value - brick.range.lo) * bins / extent, 0.0) : 0;
        return std::min(std::size_t(place), brick.counts.size() - 1);
    }
    glm::ivec3 unknown{-1};

private:
    std::shared_ptr<const BrickSource> source_;
    int bins_;
    double step_;
};

Dataset twoChannels(bool whole) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const Lattice lattice = test::ccLattice({41, 37, 29}, {1, 0.5, 2}, {3, 0, -1});
    Field a = test::sampled<std::uint8_t>(
        lattice, [&](glm::dvec3 p) { return std::clamp(100 + 2 * p.x + 10 * normal(random), 0.0, 255.0); });
    Field b = test::sampled<float>(lattice, [&](glm::dvec3 p) { return 101325 + p.z + std::exp(normal(random)); });
    if (!whole) {
        test::removeWhere(a, [&](glm::dvec3 p) { return p.x > 20 && p.z < 9; });
        test::removeWhere(b, [&](glm::dvec3) { return random() % 3 == 0; });
    }
    Dataset dataset = test::datasetOf({a, b});
    // Every cell is alike: samples lie in the middle of theirs.
    dataset.info.bounds = {lattice.origin - 0.5 * lattice.spacing,
                           lattice.origin + lattice.spacing * (glm::dvec3(lattice.size) - 0.5)};
    return dataset;
}

// Against the samples: whatever can be exact is, the rest is off by no more than it says.
TEST(NotedStatistics, KeepTheirPromises) {
    for (const bool whole : {true, false})
        for (const LatticeKind lattice : {LatticeKind::CC, LatticeKind::BCC})
            for (const int bins : {1, 4, 32}) {
                MemorySourceOptions options;
                options.brickSize = 16;
                options.lattice = lattice;
                const auto source = makeMemorySource(twoChannels(whole), options);
                const bool integers = lattice == LatticeKind::CC;
                for (int channel = 0; channel < 2; ++channel) {
                    const NotedSource noted(source, bins, channel == 0 && integers ? 1 : 0);
                    StatisticsQuery query;
                    query.channels = {channel};
                    query.bins = 50;
                    if (channel == 1) query.ranges = {{101330, 101350}}; // not all of it
                    const auto estimate = notedStatistics(noted, query);
                    ASSERT_TRUE(estimate);
                    const Statistics exact = computeStatistics(*source, query);
                    const ChannelStatistics &a = estimate->channels[0], &b = exact.channels[0];
                    EXPECT_EQ(a.all.samples, b.all.samples);
                    EXPECT_EQ(a.all.min, b.all.min);
                    EXPECT_EQ(a.all.max, b.all.max);
                    // Of BCC the box cuts cells in two: within a brick the noted mean is one of samples.
                    EXPECT_NEAR(a.all.mean, b.all.mean, (integers ? 1e-6 : 0.02) * (b.all.max - b.all.min));
                    EXPECT_EQ(a.inside.samples, b.inside.samples);
                    EXPECT_EQ(a.outside.samples, 0);
                    if (whole) {
                        EXPECT_NEAR(a.all.volume, b.all.volume, 1e-9 * b.all.volume);
                    } else {
                        EXPECT_NEAR(a.all.volume, b.all.volume, 0.05 * b.all.volume);
                    }
                    double squares = 0; // of the widths of the bins
                    std::vector<double> mostOff(51, 1);
                    const glm::ivec3 count = source->grid().count();
                    for (int n = 0; n < count.x * count.y * count.z; ++n) {
                        const auto brick = noted.distribution(
                            {channel, 0, 0, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}});
                        if (brick->samples == 0) continue;
                        const double width = (brick->range.hi - brick->range.lo) / double(brick->counts.size());
                        squares += double(brick->samples) * width * width;
                        for (std::size_t border = 0; border <= 50; ++border) {
                            const double at = b.histogram.range.lo +
                                              (b.histogram.range.hi - b.histogram.range.lo) * double(border) / 50;
                            if (at < brick->range.lo || at > brick->range.hi) continue;
                            mostOff[border] += brick->counts[NotedSource::binOf(*brick, at)];
                        }
                    }
                    EXPECT_NEAR(a.all.deviation, b.all.deviation,
                                std::sqrt(squares / a.all.samples) + (integers ? 0 : 0.02 * (b.all.max - b.all.min)));
                    ASSERT_EQ(a.histogram.count.size(), b.histogram.count.size());
                    EXPECT_EQ(a.histogram.range, b.histogram.range);
                    double estimated = 0, true_ = 0;
                    for (std::size_t bin = 0; bin < 50; ++bin) {
                        estimated += double(a.histogram.count[bin]);
                        true_ += double(b.histogram.count[bin]);
                        EXPECT_EQ(a.histogram.focus[bin], double(a.histogram.count[bin]));
                        EXPECT_LE(std::abs(estimated - true_), mostOff[0] + mostOff[bin + 1]) << bins << " " << bin;
                    }
                }
            }
}

// Of integers with few values to a bin nothing is lost.
TEST(NotedStatistics, FewIntegersAreExact) {
    std::mt19937 random(1);
    const Lattice lattice = test::ccLattice({20, 20, 20});
    const Field field = test::sampled<std::uint8_t>(lattice, [&](glm::dvec3) { return 3 + random() % 5 * 2; });
    MemorySourceOptions options;
    options.brickSize = 8;
    options.lattice = LatticeKind::CC;
    const auto source = makeMemorySource(test::datasetOf({field}), options);
    StatisticsQuery query;
    query.channels = {0};
    query.bins = 64;
    query.ranges = {{0, 20}};
    const auto noted = notedStatistics(NotedSource(source, 16, 1), query);
    ASSERT_TRUE(noted);
    EXPECT_EQ(noted->channels[0].histogram.count, computeStatistics(*source, query).channels[0].histogram.count);
}

TEST(NotedStatistics, AreNotGuessed) {
    MemorySourceOptions options;
    options.brickSize = 16;
    const auto source = makeMemorySource(twoChannels(true), options);
    StatisticsQuery query;
    query.channels = {0, 1};
    EXPECT_FALSE(notedStatistics(*source, query)); // fields in memory are read at once
    NotedSource noted(source, 8, 0);
    EXPECT_TRUE(notedStatistics(noted, query));
    noted.unknown = {1, 0, 1};
    EXPECT_FALSE(notedStatistics(noted, query));
    noted.unknown = {-1, 0, 0};
    query.pairs = allPairs(2);
    EXPECT_FALSE(notedStatistics(noted, query));
    query.pairs.clear();
    query.doi = [](std::span<const float>, glm::dvec3) { return 1.0; };
    EXPECT_FALSE(notedStatistics(noted, query));
}

} // namespace
} // namespace tessera::volume
