#include "tests/vis/raycast_compare.h"
#include "volume/derived/derived.h"
#include "volume/field/time_pair.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace tessera::vis {
namespace {

/// The test data set at two times.
std::shared_ptr<ThreeTimes> series(LatticeKind kind, bool masked) {
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return std::floor(p.x / 5.1); };
    return std::make_shared<ThreeTimes>(source(kind, masked),
                                        wavySource(kind, {laterA(masked), laterB(), {"label", label, {0, 5}, true}}));
}

struct Between {
    HeadlessContext context;
    std::shared_ptr<ThreeTimes> data;
    Renderer renderer;
    ViewTargetPtr target;
    Between(LatticeKind kind, bool masked, bool bricked = false)
        : data(series(kind, masked)), renderer(optionsFor(true, bricked)) {
        renderer.setSource(data);
        target = renderer.makeTarget();
    }
    Linear draw(const Scene& scene) { return drawWhole(renderer, *target, scene); }
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

/// The value of "b" at a time between 1 and 3, and its square.
double bAt(glm::dvec3 p, double time) {
    const double weight = (time - 1) / 2;
    return (1 - weight) * *wavyB(false).function(p) + weight * *laterB().function(p);
}

// The square of the mean, beside data that have it as they are; the mean of the squares is another picture. Dragged
// time shows that until it rests.
TEST(BetweenTimesMore, FormulasAreComputedAtTheTimeItself) {
    for (const bool bricked : {false, true}) {
        constexpr double kTime = 1.8;
        Between between(LatticeKind::BCC, false, bricked);
        const auto squared = volume::derive(between.data, {"sq", "", volume::ExpressionRecipe{"b * b"}});
        between.renderer.setSource(squared);
        Scene scene = baseScene(true);
        scene.transfer["sq"].autoRange = false;
        scene.transfer["sq"].range = {0, 2};
        scene.transfer["sq"].opacity = {{0, 0}, {1, 0.5f}};
        scene.layers = {{"sq", true, VolumeLayer{.channel = "sq"}}};
        scene.time = kTime;
        const auto direct = wavySource(LatticeKind::BCC, {{"sq",
                                                           [](glm::dvec3 p) -> std::optional<double> {
                                                               const double b = bAt(p, kTime);
                                                               return b * b;
                                                           },
                                                           {0, 3}}});
        const Linear got = between.draw(scene), wanted = reference::render(scene, *direct, kSize, {});
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        EXPECT_TRUE(agrees(difference)) << words(difference) << " " << evidence("computed between", got, wanted);

        FrameRequest moving;
        moving.size = kSize;
        moving.moving = true;
        const auto drawn = [&](const FrameRequest& request) {
            for (int i = 0; i < 2000; ++i) {
                if (between.renderer.render(*between.target, scene, request).complete && i > 20) break;
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            Linear image;
            image.size = kSize;
            for (const glm::vec4& pixel : between.renderer.readLinear(*between.target))
                image.pixels.emplace_back(pixel);
            return image;
        };
        scene.time = 2.2;
        drawn(moving);
        scene.time = kTime; // what is computed there is resident
        drawn(moving);
        moving.moving = false;
        const Linear rested = drawn(moving);
        EXPECT_TRUE(agrees(reference::compare(rested, wanted, kOutlier)))
            << words(reference::compare(rested, wanted, kOutlier));
    }
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
