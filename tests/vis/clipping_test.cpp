#include "vis/scene/clipping.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

TEST(Clipping, IntervalsAreWherePointsAreInside) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    int crossed = 0;
    for (int i = 0; i < 1000; ++i) {
        Clip clip;
        clip.kind = ClipKind(i % 4);
        clip.keep = ClipKeep(i / 4 % 2);
        clip.center = glm::vec3(vector()) * 0.3f + 0.5f;
        clip.axis = glm::vec3(vector());
        clip.size = glm::abs(glm::vec3(vector())) + 0.1f;
        clip.radius = 0.1f + 0.4f * float(std::abs(number(random)));
        WorldFrame frame;
        const PlacedClip placed = placeClips({clip}, frame).front();
        EXPECT_EQ(placed.hole, clip.keep == ClipKeep::Outside && clip.kind != ClipKind::Plane);
        const Ray ray{vector(), glm::normalize(vector())};
        const RaySegment in = placed.inside(ray);
        for (int k = 0; k < 20; ++k) {
            const double t = 2 * number(random);
            const glm::dvec3 p = ray.origin + t * ray.direction;
            EXPECT_EQ(placed.contains(p), t > in.enter && t < in.exit) << i;
            EXPECT_EQ(kept({placed}, p), placed.contains(p) != placed.hole);
            crossed += placed.contains(p) ? 1 : 0;
        }
    }
    EXPECT_GT(crossed, 2000);
}

TEST(Clipping, SamplesCountAsFarAsTheyReachOutOfHoles) {
    EXPECT_EQ(coverage({}, 3), 1);
    EXPECT_EQ(coverage({{2.75, 10}}, 3), 0.25);
    EXPECT_NEAR(coverage({{-5, 2.6}, {3.25, 9}}, 3), 0.65, 1e-12);
    EXPECT_EQ(coverage({{-5, 9}, {3.25, 9}}, 3), 0);
}

TEST(Clipping, PlanesKeepWhatTheirAxisPointsAwayFrom) {
    Clip plane{.center = {0.75f, 0.5f, 0.5f}};
    WorldFrame frame;
    EXPECT_TRUE(kept(placeClips({plane}, frame), {0.2, 0, 0}));
    EXPECT_FALSE(kept(placeClips({plane}, frame), {0.3, 0, 0}));
    plane.keep = ClipKeep::Outside;
    EXPECT_TRUE(kept(placeClips({plane}, frame), {0.3, 0, 0}));
    plane.enabled = false;
    EXPECT_TRUE(placeClips({plane}, frame).empty());
    EXPECT_EQ(placeClips(std::vector<Clip>(20), frame).size(), std::size_t(kMaxClips));
}

} // namespace
} // namespace tessera::vis
