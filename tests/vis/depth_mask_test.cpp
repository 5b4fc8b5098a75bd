#include "vis/processor/masked_depths.h"

#include "vis/formulas/depth_mask.h"

#include <cmath>
#include <gtest/gtest.h>

/// Shadows of depth: along a straight edge against the integral of the Gaussian, and what they leave as it is.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kMaskSize{120, 100};
constexpr double kNear = 0.3, kFar = 0.8; ///< depths

/// The left half near, the right half far, all of one colour.
struct Edge {
    Scene scene;
    WorldFrame frame;
    packet::PacketPicture picture{.box = {}, .rgba = {}};

    Edge() {
        scene.camera = {};
        scene.depthMask = {.strength = 1.5f, .width = 0.2f};
        picture.begin(kMaskSize, {{0, 0}, kMaskSize}, true);
        const DepthSpan span = depthSpan(scene.camera, frame);
        for (std::size_t i = 0; i < picture.pick.size(); ++i) {
            const double depth = int(i) % kMaskSize.x < kMaskSize.x / 2 ? kNear : kFar;
            picture.pick[i] = float(depth / span.perDistance + span.near);
            for (std::size_t c = 0; c < 4; ++c) picture.rgba[4 * i + c] = c == 3 ? 0.5f : 0.25f;
        }
    }
    /// Light of a pixel of the middle row after masking, by that before.
    double factor(int x) const {
        const packet::PacketPicture out = maskedDepths(picture, scene, frame);
        return double(out.rgba[4 * std::size_t(50 * kMaskSize.x + x)]) / 0.25;
    }
};

/// Share of a Gaussian over the unit disc, its deviation half the radius, that lies beyond a line `away` radii from the
/// middle.
double shareBeyond(double away) {
    double sum = 0, beyond = 0;
    for (int j = 0; j < 400; ++j)
        for (int i = 0; i < 400; ++i) {
            const double x = (i + 0.5) / 200 - 1, y = (j + 0.5) / 200 - 1, square = x * x + y * y;
            if (square > 1) continue;
            const double weight = std::exp(-2 * square);
            sum += weight;
            if (x < -away) beyond += weight;
        }
    return beyond / sum;
}

TEST(DepthMask, DarkensWhatLiesBehindAnEdgeByTheGaussian) {
    const Edge edge;
    const double radius = 0.2 * kMaskSize.y;
    for (const int x : {62, 64, 68, 72, 76}) {
        const double mean = shareBeyond((x + 0.5 - 60) / radius) * (kNear - kFar);
        EXPECT_NEAR(edge.factor(x), 1 + 1.5 * mean, 0.03) << x;
    }
    EXPECT_LT(edge.factor(62), 0.75);
    EXPECT_NEAR(edge.factor(82), 1, 1e-6) << "beyond its width";
    for (const int x : {10, 50, 57}) EXPECT_EQ(edge.factor(x), 1) << "nothing stands before what is near";
}

TEST(DepthMask, LightensWhatIsNearOnlyWhenAsked) {
    Edge edge;
    edge.scene.depthMask.lighten = true;
    for (const int x : {44, 50, 57}) {
        const double mean = (1 - shareBeyond((x + 0.5 - 60) / (0.2 * kMaskSize.y))) * (kFar - kNear);
        EXPECT_NEAR(edge.factor(x), 1 + 1.5 * mean, 0.03) << x;
    }
    EXPECT_NEAR(edge.factor(62), Edge().factor(62), 1e-6);
}

TEST(DepthMask, DarkensTheGroundThroughTheOpacity) {
    const Edge edge;
    const packet::PacketPicture out = maskedDepths(edge.picture, edge.scene, edge.frame);
    const float* const color = out.rgba.data() + 4 * (50 * kMaskSize.x + 62);
    const double factor = double(color[0]) / 0.25;
    EXPECT_NEAR(color[3], 1 - 0.5 * factor, 1e-6);
    // Over a ground of 1 the whole is darkened by the factor.
    EXPECT_NEAR(double(color[0]) + (1 - double(color[3])), factor * (0.25 + 0.5), 1e-6);
}

TEST(DepthMask, NothingSeenIsFar) {
    Edge edge;
    for (std::size_t i = 0; i < edge.picture.pick.size(); ++i)
        if (int(i) % kMaskSize.x >= kMaskSize.x / 2) edge.picture.pick[i] = -1e9f;
    EXPECT_NEAR(edge.factor(64), 1 + 1.5 * shareBeyond(4.5 / 20) * (kNear - 1), 0.04);
    edge.picture.pick.assign(edge.picture.pick.size(), -1e9f);
    EXPECT_EQ(edge.factor(64), 1);
}

TEST(DepthMask, DepthsSpanTheBox) {
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        Camera camera;
        camera.projection = projection;
        const WorldFrame frame{.halfSize = {0.5, 0.2, 0.1}};
        const DepthSpan span = depthSpan(camera, frame);
        const Ray middle = cameraRay(camera, 1, {0, 0});
        const double center = glm::dot(-middle.origin, middle.direction);
        EXPECT_NEAR((center - span.near) * span.perDistance, 0.5, 1e-12);
        EXPECT_NEAR((center + glm::length(frame.halfSize) - span.near) * span.perDistance, 1, 1e-12);
    }
}

} // namespace
} // namespace tessera::vis
