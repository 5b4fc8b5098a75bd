#include "vis/scene/stereo.h"

#include "vis/formulas/anaglyph.h"
#include "vis/optics/ray_setup.h"
#include "vis/processor/anaglyph.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

glm::dvec2 seenAt(const Camera& camera, double aspect, glm::dvec3 world) {
    const glm::dvec4 clip = projectionMatrix(camera, aspect) * viewMatrix(camera) * glm::dvec4(world, 1);
    return glm::dvec2(clip) / clip.w;
}

// Of a point at depth D the eyes, E apart, see images E (1/d - 1/D) / (tan(fov / 2) aspect) apart in units of half the
// picture: d is the distance at which they see the same.
TEST(Stereo, EyesSeeApartAsOffAxisProjectionSays) {
    constexpr double kAspect = 1.4;
    Camera camera;
    camera.aperture = 0.1f;
    for (const float convergence : {0.7f, 1.0f, 1.4f}) {
        const Stereo stereo{.kind = StereoKind::Anaglyph, .eyeDistance = 0.08f, .convergence = convergence};
        const Camera left = eyeCamera(camera, stereo, Eye::Left), right = eyeCamera(camera, stereo, Eye::Right);
        EXPECT_EQ(left.aperture, 0) << "no depth of field";
        for (const int pass : {0, 1, 5}) EXPECT_EQ(lensCamera(left, pass, 8).lens, left.lens) << "in every pass";
        const double apart = 0.08 * double(camera.distance), same = double(convergence) * double(camera.distance);
        const double half = std::tan(glm::radians(double(camera.fieldOfView)) / 2) * kAspect;
        const glm::dvec3 forward = forwardOf(camera);
        for (const double depth : {1.6, 2.2, 2.7}) {
            const glm::dvec3 at = glm::dvec3(camera.target) + forward * (depth - double(camera.distance));
            const glm::dvec2 a = seenAt(left, kAspect, at), b = seenAt(right, kAspect, at);
            EXPECT_NEAR(b.x - a.x, apart * (1 / same - 1 / depth) / half, 1e-6);
            EXPECT_NEAR(a.y, b.y, 1e-9) << "nothing is displaced upwards";
            EXPECT_NEAR((a.x + b.x) / 2, seenAt(camera, kAspect, at).x, 1e-6);
            // Rays of the ray caster agree with what is rasterised.
            const Ray ray = cameraRay(right, kAspect, b);
            EXPECT_LT(glm::length(glm::cross(at - ray.origin, ray.direction)), 1e-5);
        }
    }
    EXPECT_EQ(eyeCamera(camera, {}, Eye::Left), camera) << "off: the camera as it is";
}

TEST(Stereo, AnaglyphsAreTheLeastSquaresOfDubois) {
    // White in both is white: the columns of both matrices together keep grey nearly grey.
    const glm::dvec3 white = anaglyphColor<double>(glm::dvec3(1), glm::dvec3(1));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 0.02);
    // The left picture alone is red, the right one alone cyan.
    const glm::dvec3 left = anaglyphColor<double>(glm::dvec3(1), glm::dvec3(0));
    EXPECT_EQ(left.r, 1);
    EXPECT_EQ(left.g, 0);
    EXPECT_EQ(left.b, 0);
    const glm::dvec3 right = anaglyphColor<double>(glm::dvec3(0), glm::dvec3(1));
    EXPECT_EQ(right.r, 0);
    EXPECT_EQ(right.g, 1);
    EXPECT_EQ(right.b, 1);
    const glm::dvec3 mixed = anaglyphColor<double>({0.2, 0.4, 0.6}, {0.5, 0.3, 0.1});
    EXPECT_NEAR(mixed.r,
                0.2 * 0.4561 + 0.4 * 0.500484 + 0.6 * 0.176381 - 0.5 * 0.0434706 - 0.3 * 0.0879388 - 0.1 * 0.00155529,
                1e-12);
    EXPECT_NEAR(mixed.g,
                -0.2 * 0.0400822 - 0.4 * 0.0378246 - 0.6 * 0.0157589 + 0.5 * 0.378476 + 0.3 * 0.73364 - 0.1 * 0.0184503,
                1e-12);
    EXPECT_NEAR(mixed.b,
                -0.2 * 0.0152161 - 0.4 * 0.0205971 - 0.6 * 0.00546856 - 0.5 * 0.0721527 - 0.3 * 0.112961 + 0.1 * 1.2264,
                1e-12);
}

TEST(Stereo, PicturesInMemoryAreCombinedPixelByPixel) {
    MemoryTexture left{.size = {3, 2}, .rgba = std::vector<std::uint8_t>(24)}, right = left;
    for (std::size_t i = 0; i < 24; ++i) {
        left.rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(10 * i);
        right.rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(255 - 7 * i);
    }
    const MemoryTexture both = anaglyphOf(left, right);
    ASSERT_EQ(both.rgba.size(), 24u);
    for (std::size_t at = 0; at < 24; at += 4) {
        const auto linear = [&](const MemoryTexture& picture) {
            return linearFromSrgb(glm::dvec3(picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2]) / 255.0);
        };
        const glm::dvec3 wanted = anaglyphColor<double>(linear(left), linear(right));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(both.rgba[at + std::size_t(c)], 255 * srgbFromLinear(wanted[c]), 1) << at;
        EXPECT_EQ(both.rgba[at + 3], 255);
    }
}

} // namespace
} // namespace tessera::vis
