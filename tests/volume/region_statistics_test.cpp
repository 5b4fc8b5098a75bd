#include "volume/analysis/region_statistics.h"

#include "tests/volume/cell_data.h"
#include "volume/flow/flow_channels.h"
#include "volume/flow/sections.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

using test::cellData;
using test::cellSource;
using test::forAll;

TEST(RegionStatistics, AgreeWithBruteForce) {
    const Lattice cc = test::ccLattice({9, 11, 19}, {0.5, 0.25, 2}, {1, -2, 3});
    for (const Lattice& lattice : {cc, bccFor(cc)}) {
        const Dataset data = cellData(lattice, test::boxOf(cc));
        const auto source = cellSource(data);
        RegionStatisticsQuery query;
        query.channels = {0, 2};
        query.label = 1;
        query.regions = {3, 1, 8}; // of the last there is none
        const RegionStatistics got = computeRegionStatistics(*source, query);
        EXPECT_EQ(got.regions, query.regions);
        EXPECT_EQ(got.allSamples, double(lattice.count()));
        EXPECT_NEAR(got.allVolume, 4 * 2.5 * 36, 1e-8);
        const Field label = data.read(test::kRegion, 0, 0);
        for (std::size_t r = 0; r <= 3; ++r)
            for (std::size_t c = 0; c < 2; ++c) {
                const Field field = data.read(c == 0 ? test::kO2 : test::kRho, 0, 0);
                double n = 0, sum = 0, squares = 0, volume = 0, lo = INFINITY, hi = -INFINITY, any = 0;
                forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
                    if (r < 3 && !(label.present(i) && label.value(i) == query.regions[r])) return;
                    ++any;
                    if (!field.present(i)) return;
                    const double v = double(float(field.value(i)));
                    double cell = lattice.kind == LatticeKind::BCC ? 0.5 : 1;
                    for (int axis = 0; axis < 3; ++axis) cell *= test::cellLength(lattice, data.info.bounds, at, axis);
                    n += 1;
                    sum += cell * v;
                    squares += cell * v * v;
                    volume += cell;
                    lo = std::min(lo, v);
                    hi = std::max(hi, v);
                });
                const Summary& summary = r < 3 ? got.summary[r][c] : got.all[c];
                EXPECT_EQ(r < 3 ? got.samples[r] : got.allSamples, any);
                EXPECT_EQ(summary.samples, n);
                if (n == 0) {
                    EXPECT_TRUE(std::isnan(summary.mean));
                    continue;
                }
                EXPECT_NEAR(summary.volume, volume, 1e-9 * volume);
                const double mean = sum / volume;
                EXPECT_NEAR(summary.mean, mean, 1e-9);
                EXPECT_NEAR(summary.integral, sum, 1e-9 * volume);
                EXPECT_NEAR(summary.deviation, std::sqrt(squares / volume - mean * mean), 1e-7);
                EXPECT_EQ(summary.min, lo);
                EXPECT_EQ(summary.max, hi);
            }
        EXPECT_EQ(labelValues(*source, 1, 0), (std::vector<int>{0, 1, 3}));
    }
}

TEST(RegionStatistics, SamplesCountByTheirDegreeOfInterest) {
    const Lattice cc = test::ccLattice({9, 11, 19}, {0.5, 0.25, 2}, {1, -2, 3});
    const Dataset data = cellData(cc, test::boxOf(cc));
    const auto source = cellSource(data);
    RegionStatisticsQuery query;
    query.channels = {0, 2};
    query.label = 1;
    query.regions = {3, 1};
    query.doi = [](std::span<const float> values, glm::dvec3 at) {
        return !(values[1] > 1.5f) ? 0 : at.z < 20 ? 1 : 0.25;
    };
    const RegionStatistics got = computeRegionStatistics(*source, query);
    const Field label = data.read(test::kRegion, 0, 0), o2 = data.read(test::kO2, 0, 0),
                rho = data.read(test::kRho, 0, 0);
    EXPECT_EQ(got.allSamples, double(cc.count())) << "of the grid";
    for (std::size_t r = 0; r <= 2; ++r) {
        double n = 0, any = 0, sum = 0, volume = 0, hi = -INFINITY;
        forAll(cc, [&](glm::ivec3 at, std::size_t i) {
            if (r < 2 && !(label.present(i) && label.value(i) == query.regions[r])) return;
            const double share = !(float(rho.value(i)) > 1.5f) ? 0 : cc.position(at).z < 20 ? 1 : 0.25;
            any += share;
            if (!o2.present(i) || share == 0) return;
            double cell = share;
            for (int axis = 0; axis < 3; ++axis) cell *= test::cellLength(cc, data.info.bounds, at, axis);
            n += share;
            sum += cell * double(float(o2.value(i)));
            volume += cell;
            if (share >= 0.5) hi = std::max(hi, double(float(o2.value(i))));
        });
        const Summary& summary = r < 2 ? got.summary[r][0] : got.all[0];
        EXPECT_NEAR(r < 2 ? got.samples[r] : any, any, 1e-9);
        EXPECT_NEAR(summary.samples, n, 1e-9);
        EXPECT_NEAR(summary.mean, sum / volume, 1e-9);
        EXPECT_EQ(summary.max, hi);
    }
}

TEST(RegionStatistics, PartsAreFoundByNameAndUnit) {
    const Lattice cc = test::ccLattice({3, 3, 3});
    const DatasetInfo info = cellData(cc, test::boxOf(cc)).info;
    EXPECT_EQ(velocityChannels(info), (std::array{3, 4, 5}));
    EXPECT_EQ(velocityChannels(info, "U"), (std::array{3, 4, 5}));
    EXPECT_EQ(velocityChannels(info, "W"), std::nullopt);
    EXPECT_EQ(densityChannel(info), 2);
    EXPECT_EQ(labelChannel(info), 1);
    EXPECT_EQ(labelChannel(info, "O2"), std::nullopt);
    EXPECT_EQ(labelName(info.parameters[1], 3), "fuel");
    EXPECT_EQ(labelName(info.parameters[1], 7), "region 7");
    EXPECT_EQ(labelValue(info.parameters[1], "air"), 1);
    EXPECT_EQ(labelValue(info.parameters[1], "12"), 12);
    EXPECT_EQ(labelValue(info.parameters[1], "1x"), std::nullopt);
    DatasetInfo other = info;
    other.parameters[3].unit = "A/m2"; // a current is no velocity
    EXPECT_EQ(velocityChannels(other), std::nullopt);
    other.parameters[3].unit = "";
    EXPECT_EQ(velocityChannels(other), (std::array{3, 4, 5}));
    other.parameters[3].unit = "cm/s";
    EXPECT_TRUE(velocityChannels(other));
}

} // namespace
} // namespace tessera::volume
