#include "tests/volume/fields.h"
#include "volume/analysis/statistics.h"
#include "volume/import/import.h"
#include "volume/resample/resample.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

/// Real volumes through import, BCC, bricks and statistics: small ones of every type, size and shape.
namespace tessera::volume {
namespace {

std::filesystem::path dataFolder() {
    const char* stated = std::getenv("TESSERA_DATA");
    return stated != nullptr ? stated : TESSERA_TEST_DATA;
}

class RealVolume : public testing::TestWithParam<const char*> {};

TEST_P(RealVolume, KeepsItsRangeAndItsMeanOnBcc) {
    const std::filesystem::path file = dataFolder() / "volumes" / GetParam();
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
    const Dataset dataset = openFiles({file.string()}, {});
    const auto cc = makeMemorySource(dataset, {LatticeKind::CC, 32, std::size_t(1) << 30});
    const auto bcc = makeMemorySource(dataset, {LatticeKind::BCC, 32, std::size_t(1) << 30});
    EXPECT_EQ(bcc->info().bounds, cc->info().bounds);
    EXPECT_NEAR(double(bcc->grid().lattice.count()) / double(cc->grid().lattice.count()), 0.7071, 0.03);
    StatisticsQuery query;
    query.channels = {0};
    query.time = int(dataset.info.times.size()) - 1;
    query.ranges = {{-1e6, 1e6}};
    const Summary fine = computeStatistics(*cc, query).channels[0].all;
    ASSERT_GT(fine.samples, 0u);
    for (int level = 0; level < bcc->grid().levels; ++level) {
        query.level = level;
        const Summary summary = computeStatistics(*bcc, query).channels[0].all;
        EXPECT_GE(summary.min, fine.min);
        EXPECT_LE(summary.max, fine.max);
        // Coarse levels are a preview: a partial block at a face counts as much as a whole one.
        EXPECT_NEAR(summary.mean, fine.mean, (level == 0 ? 0.1 : 0.4) * fine.deviation) << "level " << level;
        EXPECT_LE(summary.deviation, (level == 0 ? 1.02 : 1.2) * fine.deviation) << "level " << level;
        EXPECT_NEAR(summary.volume, fine.volume, 1e-9 * fine.volume);
    }
}

INSTANTIATE_TEST_SUITE_P(Volumes, RealVolume,
                         testing::Values("nucleon_41x41x41_uint8.raw", "silicium_98x34x34_uint8.raw",
                                         "fuel_64x64x64_uint8.raw", "tooth_103x94x161_uint16.raw",
                                         "gfs_5var_101x46x25_c5_float32.raw",
                                         "colpex_theta_p_61x61x10_c2_t6_float32.raw"),
                         [](const auto& test) {
                             const std::string name = test.param;
                             return name.substr(0, name.find('_'));
                         });

} // namespace
} // namespace tessera::volume
