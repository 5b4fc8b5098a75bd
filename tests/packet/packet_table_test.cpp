#include "vis/packet/packet_table.h"

#include "vis/optics/preintegration.h"
#include "vis/optics/ray_setup.h"
#include "vis/packed/packet_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis::packet {
namespace {

/// Curves with steps, transparent and opaque parts.
TransferFunction someFunction(std::mt19937& random) {
    std::uniform_real_distribution<float> part(0, 1);
    TransferFunction function;
    function.colormap = "inferno";
    function.opacity = {{0, 0}};
    for (int i = 1; i < 12; ++i) {
        const float a = part(random);
        function.opacity.push_back({float(i) / 12, a < 0.5f ? 0 : a < 0.7f ? 0.001f * part(random) : a});
    }
    function.opacity.push_back({1, 1});
    return function;
}

/// Each packed entry has the colour and, to 1/2000 of it, the extinction of its place; none where there is none.
TEST(PacketTables, PackedEntriesHaveColorAndExtinction) {
    std::mt19937 random(7);
    for (int round = 0; round < 8; ++round) {
        const TransferFunction function = someFunction(random);
        const Range range{-3, 5};
        const std::vector<std::uint32_t> packed = packedTable(function, range);
        ASSERT_EQ(packed.size(), std::size_t(kPackedEntries) * 2);
        for (int i = 0; i < kPackedEntries; ++i) {
            const glm::dvec4 srgb = evaluate(function, range, -3 + 8.0 * i / (kPackedEntries - 1));
            const std::uint32_t low = packed[std::size_t(i) * 2], high = packed[std::size_t(i) * 2 + 1];
            const glm::dvec3 color = linearFromSrgb(glm::dvec3(srgb));
            ASSERT_NEAR((low & 0xffff) / double(kQuantum), color.x, 1.0 / kQuantum);
            ASSERT_NEAR((low >> 16) / double(kQuantum), color.y, 1.0 / kQuantum);
            ASSERT_NEAR((high & 0xffff) / double(kQuantum), color.z, 1.0 / kQuantum);
            const std::uint32_t bits = high >> 16;
            if (srgb.a <= 0) {
                ASSERT_EQ(bits, 0u) << "entry " << i;
                continue;
            }
            const auto found = double(std::bit_cast<float>((bits << kExtinctionShift) + (kExtinctionLeast << 23)));
            // The format ends at 2^12, where a thousandth of the reference length is opaque.
            const double wanted = std::min(-std::log2(1 - srgb.a), 4094.0);
            if (wanted > 1e-5) {
                ASSERT_NEAR(found / wanted, 1, 1.0 / 2000) << "entry " << i;
            }
        }
    }
}

/// Differences of the sums are the mean colour and extinction of segments between two places.
TEST(PacketTables, SegmentSumsAreThoseOfTheIntegrals) {
    std::mt19937 random(9);
    std::uniform_int_distribution<int> place(0, kSegmentPlaces - 1);
    const Range range{-3, 5};
    for (int round = 0; round < 8; ++round) {
        const TransferFunction function = someFunction(random);
        const IntegralFunctions functions = integralFunctions(function, range);
        const SegmentSums made = segmentSums(function, range);
        ASSERT_EQ(made.sums.size(), std::size_t(kSegmentPlaces + 2) * 4);
        int shown = 0;
        for (int i = 0; i < 300; ++i) {
            const int a = place(random), b = i % 3 == 0 ? std::min(a + 1, kSegmentPlaces - 1) : place(random);
            if (a == b) continue;
            const auto over = [&](int c) {
                return double(made.sums[std::size_t(b * 4 + 4 + c)]) - double(made.sums[std::size_t(a * 4 + 4 + c)]);
            };
            const glm::dvec4 wanted =
                preintegrated(functions, double(a) / (kSegmentPlaces - 1), double(b) / (kSegmentPlaces - 1));
            ASSERT_NEAR(1 - std::exp2(-over(3) / (b - a) * double(made.extinction)), wanted.a, 1e-5);
            if (wanted.a < 0.01) continue;
            ++shown;
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(over(c) / over(3), wanted[c], 1e-3);
        }
        EXPECT_GT(shown, 50);
    }
}

/// Also where a segment begins and ends at one place.
TEST(PacketTables, SegmentSumsAroundPlacesAreTheirDensities) {
    TransferFunction function;
    function.opacity = {{0, 0.3f}, {0.25f, 0.1f}, {1, 0.8f}};
    const SegmentSums made = segmentSums(function, {0, 1});
    const IntegralFunctions functions = integralFunctions(function, {0, 1});
    for (int i = 0; i < kSegmentPlaces; i += i == 0 ? 6 : 9) {
        const double extinction =
            (double(made.sums[std::size_t(i) * 4 + 11]) - double(made.sums[std::size_t(i) * 4 + 3])) / 2 *
            double(made.extinction);
        const double at = double(i) / (kSegmentPlaces - 1);
        ASSERT_NEAR(1 - std::exp2(-extinction), preintegrated(functions, at, at).a, 3e-4) << i;
    }
}

/// Without any opacity there is nothing to divide by.
TEST(PacketTables, SegmentSumsOfNothingAreZero) {
    TransferFunction function;
    function.opacity = {{0, 0}, {1, 0}};
    for (const std::int32_t sum : segmentSums(function, {0, 1}).sums) ASSERT_EQ(sum, 0);
}

/// Wherever the table has opacity, mayShow() must look: clamped places between entries, too.
TEST(PacketTables, ShownBitsCoverAllOpacity) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> anywhere(0, 1);
    int hidden = 0;
    for (int round = 0; round < 8; ++round) {
        const Table table = makeTable(someFunction(random), {0, 1});
        LayerView layer;
        markShown(table, layer);
        for (int i = 0; i < 20000; ++i) {
            const double place = i == 0 ? 0 : i == 1 ? 1 : anywhere(random);
            const auto entry = std::size_t(place * (kTableEntries - 1));
            const bool some =
                table.opacity[entry] > 0 || table.opacity[std::min(entry + 1, table.opacity.size() - 1)] > 0;
            const auto bin = std::uint32_t(place * (kShowBins - 1));
            const bool shown = layer.shows[bin / 32] >> (bin % 32) & 1;
            ASSERT_TRUE(shown || !some) << place;
            hidden += !shown;
        }
    }
    EXPECT_GT(hidden, 1000) << "some places are passed over";
}

} // namespace
} // namespace tessera::vis::packet
