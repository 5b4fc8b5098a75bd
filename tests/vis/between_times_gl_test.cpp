#include "tests/vis/raycast_compare.h"
#include "volume/field/time_pair.h"

#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

/// The test data set at two times: the second one is another function in another range, absent elsewhere.
class Series : public volume::BrickSource {
public:
    Series(LatticeKind kind, bool masked) : first_(source(kind, masked)), second_(later(kind, masked)) {
        info_ = first_->info();
        info_.times = {1, 3, 4};
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return first_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return frame(key).stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override { return frame(key).read(key); }

private:
    static std::shared_ptr<FunctionSource> later(LatticeKind kind, bool masked) {
        const auto a = [=](glm::dvec3 p) -> std::optional<double> {
            if (masked && glm::length((p - glm::dvec3(10, 9, 11)) / glm::dvec3(9, 8, 12)) > 1) return std::nullopt;
            return 310 + 20 * std::cos(0.35 * p.x - 0.3 * p.z) + 2 * p.y;
        };
        const auto b = [=](glm::dvec3 p) -> std::optional<double> {
            return 0.8 - 0.02 * p.x + 0.3 * std::sin(0.3 * p.z);
        };
        const auto label = [](glm::dvec3 p) -> std::optional<double> { return std::floor(p.x / 5.1); };
        return std::make_shared<FunctionSource>(kind, glm::ivec3(19, 17, 25), glm::dvec3(1),
                                                std::vector<FunctionSource::Channel>{{"a", a, {225, 375}},
                                                                                     {"b", b, {-0.3, 1.7}},
                                                                                     {"label", label, {0, 5}, true}},
                                                8, glm::dvec3(0.137, 0.211, 0.173));
    }
    const FunctionSource& frame(const volume::BrickKey& key) const { return key.time == 1 ? *second_ : *first_; }
    std::shared_ptr<FunctionSource> first_, second_;
    volume::DatasetInfo info_;
};

struct Between {
    HeadlessContext context;
    std::shared_ptr<Series> data;
    Renderer renderer;
    ViewTargetPtr target;
    Between(LatticeKind kind, bool masked, bool bricked = false)
        : data(std::make_shared<Series>(kind, masked)), renderer(optionsFor(true, bricked)) {
        renderer.setSource(data);
        target = renderer.makeTarget();
    }
    Linear draw(const Scene& scene) {
        FrameRequest request;
        request.size = kSize;
        request.wait = true;
        EXPECT_TRUE(renderer.render(*target, scene, request).complete);
        Linear image;
        image.size = kSize;
        for (const glm::vec4& pixel : renderer.readLinear(*target)) image.pixels.emplace_back(pixel);
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
        return image;
    }
    void check(const std::string& name, const Scene& scene) {
        const Linear got = draw(scene), wanted = reference::render(scene, *data, kSize, {});
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        EXPECT_TRUE(agrees(difference)) << name << ": " << words(difference) << " " << evidence(name, got, wanted);
    }
};

Scene mixedScene() {
    Scene scene = baseScene(true);
    scene.layers = {{"a", true, VolumeLayer{.channel = "a"}},
                    {"b", true, IsoLayer{.channel = "b", .value = 0.6, .opacity = 0.7f}},
                    {"cut", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.8f}}};
    return scene;
}

class BetweenTimes : public testing::TestWithParam<std::pair<LatticeKind, bool>> {};

TEST_P(BetweenTimes, MixesTheStoredOnesAsTheReferenceDoes) {
    const auto [kind, masked] = GetParam();
    Between between(kind, masked);
    Scene scene = mixedScene();
    // On stored times, between them near either end and in the middle, and beyond.
    for (const double time : {0.0, 1.0, 1.3, 2.0, 2.9, 3.5}) {
        scene.time = time;
        between.check("between times " + std::to_string(time), scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Lattices, BetweenTimes,
                         testing::Values(std::pair{LatticeKind::CC, false}, std::pair{LatticeKind::CC, true},
                                         std::pair{LatticeKind::BCC, false}, std::pair{LatticeKind::BCC, true}));

TEST(BetweenTimesMore, BricksAndClassificationsMixToo) {
    Between bricked(LatticeKind::BCC, true, true);
    Scene scene = mixedScene();
    scene.time = 1.7;
    bricked.check("between times bricked", scene);
    Between dense(LatticeKind::BCC, true);
    scene.layers = {{"a", true, VolumeLayer{.channel = "a", .classification = Classification::Pre}}};
    dense.check("between times classified", scene);
}

TEST(BetweenTimesMore, LabelsAreThoseOfTheNearerTime) {
    Between between(LatticeKind::BCC, true);
    Scene scene = mixedScene();
    scene.layers = {{"label", true, VolumeLayer{.channel = "label"}}};
    const auto at = [&](double time) {
        scene.time = time;
        return between.draw(scene).pixels;
    };
    EXPECT_EQ(at(1.7), at(1));
    EXPECT_EQ(at(2.9), at(3));
    EXPECT_NE(at(1), at(3));
}

TEST(BetweenTimesMore, ATimeLiesBetweenItsNeighbours) {
    EXPECT_EQ(volume::timesAround({1, 3, 4}, 2.5), (volume::TimePair{0, 1, 0.75}));
    EXPECT_EQ(volume::timesAround({1, 3, 4}, 3), (volume::TimePair{1, 1, 0}));
    EXPECT_EQ(volume::timesAround({1, 3, 4}, 3 - 1e-9), (volume::TimePair{1, 1, 0}));
    EXPECT_EQ(volume::timesAround({1, 3, 4}, -5), (volume::TimePair{0, 0, 0}));
    EXPECT_EQ(volume::timesAround({1, 3, 4}, 9), (volume::TimePair{2, 2, 0}));
    EXPECT_EQ(volume::timesAround({2}, 2.5), (volume::TimePair{0, 0, 0}));
    EXPECT_EQ((volume::TimePair{3, 4, 0.5}).nearest(), 4);
}

} // namespace
} // namespace tessera::vis
