#include "vis/packet/packet_table.h"

#include "vis/optics/ray_setup.h"
#include "vis/packed/packet_volume.h"

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
