#include "tests/packet/packet_pictures.h"
#include "vis/packed/packet_blend.h"

#include <atomic>

/// Times between the stored ones by the packet ray caster.
namespace tessera::vis::packet {
namespace {

/// Two data sets as three times: the second time has other values in a narrower range, absent elsewhere.
class Series : public volume::BrickSource {
public:
    Series(LatticeKind kind, bool masked) : first_(source(kind, masked)), second_(later(kind, masked)) {
        info_ = first_->info();
        info_.times = {1, 3, 4};
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return first_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return frame(key).stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        ++reads;
        return frame(key).read(key);
    }
    mutable std::atomic<int> reads = 0;

private:
    static std::shared_ptr<FunctionSource> later(LatticeKind kind, bool masked) {
        const auto a = [=](glm::dvec3 p) -> std::optional<double> {
            if (masked && glm::length((p - glm::dvec3(10, 9, 11)) / glm::dvec3(9, 8, 12)) > 1) return std::nullopt;
            return 310 + 20 * std::cos(0.35 * p.x - 0.3 * p.z) + 2 * p.y;
        };
        const auto b = [=](glm::dvec3 p) -> std::optional<double> {
            return 0.8 - 0.02 * p.x + 0.3 * std::sin(0.3 * p.z);
        };
        return std::make_shared<FunctionSource>(
            kind, glm::ivec3(19, 17, 25), glm::dvec3(1),
            std::vector<FunctionSource::Channel>{{"a", a, {225, 375}}, {"b", b, {-0.3, 1.7}}, {"whole", b, {0, 1.8}}},
            8, glm::dvec3(0.137, 0.211, 0.173));
    }
    const FunctionSource& frame(const volume::BrickKey& key) const { return key.time == 1 ? *second_ : *first_; }
    std::shared_ptr<FunctionSource> first_, second_;
    volume::DatasetInfo info_;
};

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
    expectAgreement(std::make_shared<Series>(GetParam().kind, GetParam().masked), kTimeModes);
}

/// Bounds of blocks hold for every sample that is read in them.
TEST(PacketTimesMore, BoundsHoldTheSamples) {
    for (const bool masked : {false, true}) {
        const Series data(LatticeKind::BCC, masked);
        const auto at = [&](int time) { return readPacketVolume(data, {.channel = 0, .time = {time, time, 0}}); };
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

/// While a time between two runs on, the stored samples are read once.
TEST(PacketTimesMore, StoredSamplesAreReadOnce) {
    const auto data = std::make_shared<Series>(LatticeKind::CC, false);
    PacketRenderer renderer;
    renderer.setSource(data);
    Scene scene = baseScene(true);
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
