#include "vis/optics/shade.h"
#include "vis/optics/surface_light.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

constexpr double kPi = glm::pi<double>();

/// Share of even light from the upper half that a surface reflects to a viewer at this angle: the integral of
/// physicalLight over all directions (light of intensity 1 is an irradiance of pi, so divided by pi).
glm::dvec3 reflected(const Lighting& surface, glm::dvec3 albedo, double viewAngle) {
    const Facing at = facing({0, 0, 1}, {std::sin(viewAngle), 0, std::cos(viewAngle)});
    const Reflected even = evenLight(at, albedo, surface);
    glm::dvec3 sum(0);
    constexpr int kRings = 400, kSectors = 400;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSectors; ++j) {
            const double z = (i + 0.5) / kRings, turn = 2 * kPi * (j + 0.5) / kSectors, r = std::sqrt(1 - z * z);
            sum += physicalLight(at, albedo, even, {r * std::cos(turn), r * std::sin(turn), z}, surface);
        }
    return sum * (2 * kPi / (kRings * kSectors)) / kPi;
}

TEST(Lighting, PhysicalSurfacesReflectNoMoreThanTheyGet) {
    Lighting surface;
    surface.model = LightModel::Physical;
    for (const float roughness : {0.2f, 0.5f, 1.0f})
        for (const float metalness : {0.0f, 1.0f})
            for (const double angle : {0.0, 0.7, 1.2}) {
                surface.roughness = roughness;
                surface.metalness = metalness;
                const double share = reflected(surface, glm::dvec3(1), angle).x;
                EXPECT_LT(share, 1.05) << roughness << ' ' << metalness << ' ' << angle;
                EXPECT_GT(share, 0.6) << roughness << ' ' << metalness << ' ' << angle;
            }
}

TEST(Lighting, EvenLightIsTheIntegralOfTheLights) {
    Lighting surface;
    surface.model = LightModel::Physical;
    for (const float roughness : {0.3f, 0.6f, 1.0f})
        for (const double angle : {0.1, 0.6, 1.0}) {
            surface.roughness = roughness;
            const glm::dvec3 albedo(0.7, 0.3, 0.1);
            const Facing at = facing({0, 0, 1}, {std::sin(angle), 0, std::cos(angle)});
            const Reflected even = evenLight(at, albedo, surface);
            const glm::dvec3 sum = reflected(surface, albedo, angle);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(even.diffuse[k] + even.specular[k], sum[k], 0.05) << roughness;
        }
}

TEST(Lighting, BothSidesOfAGradientAreOneSurface) {
    Illumination light = illuminate({}, {});
    for (const LightModel model : {LightModel::Phong, LightModel::Physical}) {
        light.surface.model = model;
        const glm::dvec3 gradient(0.3, -0.5, 0.8), eye = glm::normalize(glm::dvec3(0.2, 0.1, 1));
        const glm::dvec3 a = shade(light, {0.5, 0.6, 0.7}, gradient, 0.8, {}, eye);
        const glm::dvec3 b = shade(light, {0.5, 0.6, 0.7}, -7.0 * gradient, 0.8, {}, eye);
        EXPECT_NEAR(glm::length(a - b), 0, 1e-12);
        EXPECT_EQ(shade(light, {0.5, 0.6, 0.7}, {}, 1, {}, eye), glm::dvec3(0.5, 0.6, 0.7));
    }
}

TEST(Lighting, LightsAddUpAndPointsFallOff) {
    const glm::dvec3 eye(0, 0, 1), albedo(0.5);
    Lighting lighting;
    lighting.ambient = 0;
    const auto lit = [&] { return shade(illuminate(lighting, {}), albedo, {0, 0, 1}, 1, {0, 0, 0}, eye).x; };
    lighting.lights = {Light{.kind = LightKind::World, .azimuth = 0, .elevation = 0}};
    const double one = lit();
    EXPECT_NEAR(one, 0.5 * double(lighting.diffuse) + double(lighting.specular), 1e-9);
    lighting.lights.push_back(lighting.lights[0]);
    EXPECT_NEAR(lit(), 2 * one, 1e-9);
    lighting.lights[1].enabled = false;
    EXPECT_NEAR(lit(), one, 1e-9);
    lighting.lights = {Light{.kind = LightKind::Point, .position = {0, 0, 2}}};
    EXPECT_NEAR(lit(), one / 4, 1e-9);
    lighting.lights.assign(40, Light{});
    EXPECT_EQ(placeLights(lighting, {}).size(), std::size_t(kMaxLights));
}

} // namespace
} // namespace tessera::vis
