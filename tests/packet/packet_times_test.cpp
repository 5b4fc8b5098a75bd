#include "tests/packet/packet_pictures.h"
#include "vis/packed/packet_blend.h"
#include "volume/derived/derived.h"

/// Times between the stored ones by the packet ray caster.
namespace tessera::vis::packet {
namespace {

std::shared_ptr<ThreeTimes> series(LatticeKind kind, bool masked) {
    FunctionSource::Channel whole = laterB();
    whole.name = "whole";
    whole.range = {0, 1.8};
    return std::make_shared<ThreeTimes>(source(kind, masked), wavySource(kind, {laterA(masked), laterB(), whole}));
}

const Mode kTimeModes[] = {
    {"all kinds of layers",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a"}),
                     layerOf(IsoLayer{.channel = "b", .value = 0.6, .opacity = 0.7f}),
                     layerOf(SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.8f})};
         s.cursor = {9, 8, 12};
         s.time = 1.3;
     }},
    {"late", // near the second time
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.time = 2.8;
     }},
    {"of 32 bits",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false})};
         s.transfer["a"].autoRange = false;
         s.transfer["a"].range = {300, 312};
         s.time = 3.6;
     }},
    {"another time for a layer",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f}),
                     layerOf(IsoLayer{.channel = "b", .value = 0.6, .opacity = 0.7f})};
         s.layers[1].timeShift = -1.2;
         s.time = 3;
     }},
    {"brushed",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .density = 3})};
         s.selection.brushes = {rangeBrush({{.channel = "a", .lo = 290, .hi = 310, .soft = 12}})};
         s.time = 1.7;
     }},
};

class PacketTimes : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketTimes, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketTimes, AgreeWithTheReference) {
    expectAgreement(series(GetParam().kind, GetParam().masked), kTimeModes);
}

/// Bounds of blocks hold for every sample that is read in them.
TEST(PacketTimesMore, BoundsHoldTheSamples) {
    for (const bool masked : {false, true}) {
        const std::shared_ptr<ThreeTimes> data = series(LatticeKind::BCC, masked);
        const auto at = [&](int time) { return readPacketVolume(*data, {.channel = 0, .time = {time, time, 0}}); };
        const PacketVolume blend = blendedVolume(at(0), at(1), 0.3);
        int some = 0, partly = 0;
        for (int n = 0; n < blend.cells.x * blend.cells.y * blend.cells.z; ++n) {
            const glm::ivec3 cell(n % blend.cells.x, n / blend.cells.x % blend.cells.y,
                                  n / blend.cells.x / blend.cells.y);
            const glm::ivec3 block = cell / kFine;
            const std::size_t own = (std::size_t(block.z) * std::size_t(blend.blocks.y) + std::size_t(block.y)) *
                                        std::size_t(blend.blocks.x) +
                                    std::size_t(block.x);
            for (int sublattice = 0; sublattice < 2; ++sublattice) {
                const std::size_t i = blend.at(cell, sublattice);
                const double weight = masked ? blend.present[i] / double(kQuantum) : 1;
                if (!(weight > 0)) continue;
                ++some;
                partly += weight < 0.99;
                ASSERT_GE(blend.shorts[i] / weight, double(blend.lo[own]) - 3);
                ASSERT_LE(blend.shorts[i] / weight, double(blend.hi[own]) + 3);
                if (weight < 0.99) {
                    ASSERT_NE(blend.absent[own], 0);
                }
            }
        }
        EXPECT_GT(some, 3000);
        EXPECT_EQ(partly > 100, masked);
    }
}

/// Formulas are computed from interpolated parameters: as the picture of data that have such values, not as a mix of
/// two pictures' samples, unless mixing is allowed.
TEST(PacketTimesMore, FormulasAreComputedAtTheTimeItself) {
    constexpr double kTime = 1.8;
    const auto squared = volume::derive(series(LatticeKind::BCC, false), {"sq", "", volume::ExpressionRecipe{"b * b"}});
    const auto square = [](glm::dvec3 p) -> std::optional<double> {
        const double weight = (kTime - 1) / 2,
                     b = (1 - weight) * *wavyB(false).function(p) + weight * *laterB().function(p);
        return b * b;
    };
    Scene scene = wavyScene(true);
    scene.transfer["sq"].autoRange = false;
    scene.transfer["sq"].range = {0, 2};
    scene.layers = {layerOf(VolumeLayer{.channel = "sq", .density = 4})};
    scene.time = kTime;
    const reference::Image wanted =
        reference::render(scene, *wavySource(LatticeKind::BCC, {{"sq", square, {0, 3}}}), kSize, {});
    PacketRenderer renderer;
    renderer.setSource(squared);
    const auto away = [&] { return reference::compare(asImage(renderer.render(scene, kSize)), wanted, kOutlier).rmse; };
    EXPECT_LT(away(), 1e-3);
    EXPECT_FALSE(renderer.mixed());
    renderer.release();
    renderer.setMixes(true);
    EXPECT_GT(away(), 1e-2) << "the test tells both apart";
    EXPECT_TRUE(renderer.mixed());
    renderer.setMixes(false);
    EXPECT_LT(away(), 1e-3) << "what is mixed does not stay";
}

/// While a time between two runs on, the stored samples are read once.
TEST(PacketTimesMore, StoredSamplesAreReadOnce) {
    const auto data = series(LatticeKind::CC, false);
    PacketRenderer renderer;
    renderer.setSource(data);
    Scene scene = wavyScene(true);
    scene.layers = {layerOf(VolumeLayer{.channel = "a"})};
    scene.time = 1.2;
    renderer.render(scene, kSize);
    const int before = data->reads;
    EXPECT_GT(before, 0);
    for (const double time : {1.4, 1.9, 2.5, 1.1}) {
        scene.time = time;
        EXPECT_TRUE(renderer.request(scene)) << "nothing is to be waited for";
        renderer.render(scene, kSize);
    }
    EXPECT_EQ(data->reads, before);
    scene.time = 3.3;
    EXPECT_FALSE(renderer.request(scene)) << "the third time is not there";
}

} // namespace
} // namespace tessera::vis::packet
