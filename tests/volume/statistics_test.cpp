#include "volume/analysis/statistics.h"

#include "tests/volume/cell_data.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <tbb/global_control.h>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

constexpr int kBins = 16;

/// Three parameters with masks of their own, the third a noisy linear function of the first.
Dataset threeChannels(const Lattice& lattice) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    Field a = sampled<float>(lattice, [&](glm::dvec3) { return 101325 + 16 * normal(random); });
    Field b = sampled<float>(lattice, [&](glm::dvec3 p) { return p.x * p.y - p.z; });
    Field c = a;
    for (float& value : c.as<float>()) value = float(2 - 0.5 * (double(value) - 101325) + 4 * normal(random));
    test::removeWhere(a, [&](glm::dvec3) { return random() % 5 == 0; });
    test::removeWhere(b, [&](glm::dvec3 p) { return p.x > 0.8 * lattice.spacing.x * lattice.size.x; });
    Dataset dataset = test::datasetOf({a, b, c});
    dataset.info.parameters[0].ranges = {{101325 - 30, 101325 + 30}}; // some values lie outside
    dataset.info.parameters[1].ranges = {{-20, 100}};
    dataset.info.parameters[2].ranges = {{-30, 30}};
    return dataset;
}

double doiOf(std::span<const float> values) {
    return std::isnan(values[0]) ? 0 : std::clamp((double(values[0]) - 101320) / 10, 0.0, 1.0);
}

StatisticsQuery fullQuery() {
    StatisticsQuery query;
    query.channels = {0, 1, 2};
    query.pairs = allPairs(3);
    query.bins = kBins;
    query.meanOf = 1;
    query.doi = [](std::span<const float> v, glm::dvec3) { return doiOf(v); };
    return query;
}

int binOf(const Range& range, double value) {
    if (value < range.lo || value > range.hi) return -1;
    return std::min(kBins - 1, int((value - range.lo) / (range.hi - range.lo) * kBins));
}

TEST(Statistics, AgreesWithBruteForce) {
    for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2, 3, 17), glm::ivec3(19, 21, 17)}) {
        Dataset dataset = threeChannels(bccFor(ccLattice(size)));
        dataset.info.bounds = test::boxOf(ccLattice(size));
        MemorySourceOptions options;
        options.brickSize = 8;
        options.lattice = LatticeKind::BCC;
        const auto source = makeMemorySource(dataset, options);
        const Statistics result = computeStatistics(*source, fullQuery());
        ASSERT_EQ(result.channels.size(), 3u);
        ASSERT_EQ(result.joint.size(), 3u);

        std::vector<Field> fields;
        for (int c = 0; c < 3; ++c) fields.push_back(dataset.read(c, 0, 0));
        const auto value = [&](int c, std::size_t i) {
            return fields[std::size_t(c)].present(i) ? float(fields[std::size_t(c)].value(i)) : NAN;
        };
        const auto doi = [&](std::size_t i) { return doiOf(std::array{value(0, i), value(1, i), value(2, i)}); };
        const std::size_t count = fields[0].count();
        std::vector<double> cell; // volume of each sample's
        test::forAll(fields[0].lattice, [&](glm::ivec3 at, std::size_t) {
            cell.push_back(0.5);
            for (int axis = 0; axis < 3; ++axis)
                cell.back() *= test::cellLength(fields[0].lattice, dataset.info.bounds, at, axis);
        });
        for (int c = 0; c < 3; ++c) {
            const ChannelStatistics& channel = result.channels[std::size_t(c)];
            std::vector<std::uint64_t> bins(kBins);
            std::vector<double> focus(kBins);
            for (const bool inside : {true, false}) {
                double n = 0, volume = 0, sum = 0, squares = 0, lo = INFINITY, hi = -INFINITY;
                for (std::size_t i = 0; i < count; ++i) {
                    const double v = double(value(c, i));
                    if (std::isnan(v)) continue;
                    const double weight = inside ? doi(i) : 1 - doi(i);
                    n += weight;
                    volume += weight * cell[i];
                    sum += weight * cell[i] * v;
                    if ((doi(i) >= 0.5) != inside) continue;
                    lo = std::min(lo, v);
                    hi = std::max(hi, v);
                    if (const int bin = binOf(channel.histogram.range, v); bin >= 0) {
                        ++bins[std::size_t(bin)];
                        focus[std::size_t(bin)] += doi(i);
                    }
                }
                for (std::size_t i = 0; i < count; ++i) {
                    const double v = double(value(c, i));
                    const double apart = v - sum / volume;
                    if (!std::isnan(v)) squares += (inside ? doi(i) : 1 - doi(i)) * cell[i] * apart * apart;
                }
                const Summary& summary = inside ? channel.inside : channel.outside;
                EXPECT_NEAR(summary.samples, n, 1e-6 * (1 + n));
                if (n == 0) {
                    EXPECT_TRUE(std::isnan(summary.mean));
                    continue;
                }
                EXPECT_NEAR(summary.mean, sum / volume, 1e-7);
                EXPECT_NEAR(summary.deviation, std::sqrt(squares / volume), 1e-5);
                if (lo > hi) continue; // none of weight 1/2
                EXPECT_EQ(summary.min, lo);
                EXPECT_EQ(summary.max, hi);
            }
            EXPECT_NEAR(channel.all.samples, channel.inside.samples + channel.outside.samples,
                        1e-6 * channel.all.samples);
            EXPECT_EQ(channel.histogram.count, bins);
            for (std::size_t b = 0; b < kBins; ++b)
                EXPECT_NEAR(channel.histogram.focus[b], focus[b], 6e-4 * double(1 + bins[b]));
        }
        for (const JointHistogram& joint : result.joint) {
            std::vector<std::uint64_t> bins(kBins * kBins);
            std::vector<double> focus(kBins * kBins);
            std::vector<double> third(kBins * kBins), thirdVolume(kBins * kBins);
            double n = 0, volume = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
            const auto both = [&](std::size_t i) {
                return !std::isnan(value(joint.x, i)) && !std::isnan(value(joint.y, i));
            };
            for (std::size_t i = 0; i < count; ++i) {
                if (!both(i)) continue;
                const double x = double(value(joint.x, i)), y = double(value(joint.y, i));
                ++n;
                volume += cell[i];
                mx += cell[i] * x;
                my += cell[i] * y;
                const int bx = binOf(joint.xRange, x), by = binOf(joint.yRange, y);
                if (bx < 0 || by < 0) continue;
                ++bins[std::size_t(by * kBins + bx)];
                focus[std::size_t(by * kBins + bx)] += doi(i);
                if (std::isnan(value(1, i))) continue;
                third[std::size_t(by * kBins + bx)] += cell[i] * std::clamp(double(value(1, i)), -20.0, 100.0);
                thirdVolume[std::size_t(by * kBins + bx)] += cell[i];
            }
            for (std::size_t b = 0; b < bins.size(); ++b) {
                EXPECT_EQ(std::isnan(joint.mean[b]), thirdVolume[b] == 0);
                if (thirdVolume[b] > 0) {
                    EXPECT_NEAR(joint.mean[b], third[b] / thirdVolume[b], 120.0 / 65535);
                }
            }
            // Correlation weighted by volume and the degree of interest, by its definition.
            for (const bool inside : {true, false}) {
                double w = 0, wx = 0, wy = 0, wxx = 0, wyy = 0, wxy = 0;
                const auto weight = [&](std::size_t i) { return cell[i] * (inside ? doi(i) : 1 - doi(i)); };
                for (std::size_t i = 0; i < count; ++i) {
                    if (!both(i)) continue;
                    w += weight(i);
                    wx += weight(i) * double(value(joint.x, i));
                    wy += weight(i) * double(value(joint.y, i));
                }
                for (std::size_t i = 0; i < count; ++i) {
                    if (!both(i)) continue;
                    const double x = double(value(joint.x, i)) - wx / w, y = double(value(joint.y, i)) - wy / w;
                    wxx += weight(i) * x * x;
                    wyy += weight(i) * y * y;
                    wxy += weight(i) * x * y;
                }
                if (size.x > 10) {
                    EXPECT_NEAR(inside ? joint.focusCorrelation : joint.outsideCorrelation, wxy / std::sqrt(wxx * wyy),
                                1e-5);
                }
            }
            for (std::size_t i = 0; i < count; ++i) {
                if (!both(i)) continue;
                const double x = double(value(joint.x, i)) - mx / volume, y = double(value(joint.y, i)) - my / volume;
                xx += cell[i] * x * x;
                yy += cell[i] * y * y;
                xy += cell[i] * x * y;
            }
            EXPECT_EQ(double(joint.samples), n);
            EXPECT_EQ(joint.count, bins);
            for (std::size_t b = 0; b < bins.size(); ++b)
                EXPECT_NEAR(joint.focus[b], focus[b], 6e-4 * double(1 + bins[b]));
            if (size.x > 1) {
                EXPECT_NEAR(joint.correlation, xy / std::sqrt(xx * yy), 1e-6);
            }
        }
        if (size.x > 10) {
            EXPECT_LT(result.joint[1].correlation, -0.85); // channels 0 and 2
        }
    }
}

TEST(Statistics, TheSameOnAnyNumberOfThreads) {
    const auto source = makeMemorySource(threeChannels(ccLattice({40, 33, 29})), {LatticeKind::BCC, 8, 1 << 30});
    StatisticsQuery query = fullQuery();
    query.binsByVolume = true;
    const Statistics many = computeStatistics(*source, query);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Statistics single = computeStatistics(*source, query);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(many.channels[c].histogram.focus, single.channels[c].histogram.focus);
        EXPECT_EQ(many.channels[c].inside.mean, single.channels[c].inside.mean);
        EXPECT_EQ(many.channels[c].histogram.focusVolume, single.channels[c].histogram.focusVolume);
        EXPECT_EQ(many.joint[c].count, single.joint[c].count);
        EXPECT_EQ(many.joint[c].volume, single.joint[c].volume);
        ASSERT_EQ(many.joint[c].mean.size(), single.joint[c].mean.size());
        for (std::size_t b = 0; b < many.joint[c].mean.size(); ++b)
            EXPECT_TRUE(many.joint[c].mean[b] == single.joint[c].mean[b] || std::isnan(single.joint[c].mean[b]));
        EXPECT_EQ(many.joint[c].correlation, single.joint[c].correlation);
    }
}

// Every lattice and level stands for the whole box, and half of it where half is selected.
TEST(Statistics, VolumesFillTheBox) {
    const Lattice cc = ccLattice({33, 17, 21}, {1e-3, 2e-3, 5e-4}, {-1, 0, 1});
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Dataset dataset = test::datasetOf({sampled<float>(cc, [](glm::dvec3 p) { return p.x; })});
        const glm::dvec3 size = dataset.info.bounds.size();
        const auto source = makeMemorySource(dataset, {kind, 16, 1 << 30});
        for (int level = 0; level < source->grid().levels; ++level) {
            StatisticsQuery query;
            query.channels = {0};
            query.level = level;
            query.doi = [&](std::span<const float> v, glm::dvec3) { return double(v[0]) < -1 + 0.016 ? 1.0 : 0.0; };
            const Statistics result = computeStatistics(*source, query);
            const double box = size.x * size.y * size.z;
            EXPECT_NEAR(result.channels[0].all.volume, box, 1e-9 * box);
            EXPECT_NEAR(result.channels[0].inside.volume, box / 2, box * 0.05 * (1 << level)) << level;
        }
    }
}

// The first layer of each BCC sublattice reaches from the face of the box half way to its next layer.
TEST(Statistics, VolumeOfALayer) {
    const Lattice cc = ccLattice({9, 8, 7}, {0.5, 1, 1}), bcc = bccFor(cc);
    Dataset dataset = test::datasetOf({sampled<float>(bcc, [](glm::dvec3 p) { return p.x; })});
    dataset.info.bounds = test::boxOf(cc);
    const auto source = makeMemorySource(dataset, {LatticeKind::BCC, 8, 1 << 30});
    const double even = bcc.origin.x + 0.5 * bcc.spacing.x, odd = bcc.origin.x + bcc.spacing.x;
    StatisticsQuery query;
    query.channels = {0};
    query.doi = [&](std::span<const float> v, glm::dvec3) { return double(v[0]) < (even + odd) / 2 ? 1.0 : 0.0; };
    const Statistics result = computeStatistics(*source, query);
    EXPECT_EQ(result.channels[0].inside.samples, double(bcc.size.y) * bcc.size.z);
    EXPECT_NEAR(result.channels[0].inside.volume, 7 * 6 * (even + odd) / 2, 1e-9);
}

TEST(Statistics, DegenerateChannels) {
    Field constant = sampled<float>(ccLattice({5, 5, 5}), [](glm::dvec3) { return 3.25; });
    Field absent = constant;
    test::removeWhere(absent, [](glm::dvec3) { return true; });
    const auto source = makeMemorySource(test::datasetOf({constant, absent}), {LatticeKind::CC, 8, 1 << 20});
    StatisticsQuery query;
    query.channels = {0, 1};
    query.pairs = {{0, 1}, {0, 0}};
    query.ranges = {{3.25, 3.25}, {0, 1}};
    const Statistics result = computeStatistics(*source, query);
    EXPECT_EQ(result.channels[0].all.samples, 125);
    EXPECT_EQ(result.channels[0].histogram.count[0], 125u);
    EXPECT_EQ(result.channels[0].all.deviation, 0);
    EXPECT_EQ(result.channels[1].all.samples, 0);
    EXPECT_TRUE(std::isnan(result.channels[1].all.mean));
    EXPECT_EQ(result.joint[0].samples, 0u);
    EXPECT_TRUE(std::isnan(result.joint[0].correlation));
    EXPECT_TRUE(std::isnan(result.joint[1].correlation));
}

TEST(Statistics, TheLastBinHoldsTheUpperEndOfTheRange) {
    const Field field = sampled<float>(ccLattice({9, 3, 2}), [](glm::dvec3 p) { return p.x; });
    const auto source = makeMemorySource(test::datasetOf({field}), {LatticeKind::CC, 8, 1 << 20});
    StatisticsQuery query;
    query.channels = {0};
    query.ranges = {{1, 7}};
    query.bins = 3;
    // 1 2 | 3 4 | 5 6 7, six samples each; 0 and 8 lie outside.
    EXPECT_EQ(computeStatistics(*source, query).channels[0].histogram.count, (std::vector<std::uint64_t>{12, 12, 18}));
}

TEST(Statistics, StopsAndReports) {
    const auto source = makeMemorySource(threeChannels(ccLattice({20, 20, 20})), {LatticeKind::CC, 8, 1 << 30});
    double last = -1;
    std::stop_source stop;
    const Progress watching{[&](double fraction, const std::string&) { last = std::max(last, fraction); },
                            stop.get_token()};
    computeStatistics(*source, fullQuery(), watching);
    EXPECT_GT(last, 0.5);
    stop.request_stop();
    EXPECT_THROW(computeStatistics(*source, fullQuery(), watching), Cancelled);
}

} // namespace
} // namespace tessera::volume
