#include "vis/optics/light_volume.h"
#include "vis/optics/surface_light.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

LightGrid cube(int edge) {
    LightGrid grid;
    grid.size = glm::ivec3(edge);
    return grid;
}

TEST(LightGrid, CellsAreAsFineAsAskedForAlongEveryEdge) {
    const WorldFrame frame = worldFrame({glm::dvec3(0), glm::dvec3(4, 2, 1)}, glm::dvec3(1));
    EXPECT_EQ(lightGrid(frame, {.resolution = 64}).size, glm::ivec3(64, 32, 16));
    const LightGrid flat =
        lightGrid(worldFrame({glm::dvec3(0), glm::dvec3(4, 2, 0)}, glm::dvec3(1)), {.resolution = 8});
    EXPECT_EQ(flat.size, glm::ivec3(8, 4, 1));
    EXPECT_GT(flat.cell().z, 0);
}

TEST(LightVolume, EvenMatterFadesLightByTheDepthItLiesAt) {
    const LightGrid grid = cube(24);
    const double extinction = 3;
    const Medium<double> medium(grid.count(), {0, 0, 0, extinction});
    const PlacedLight down{false, {0, 1, 0}, glm::dvec3(1)};
    const LightVolume<double> light = spreadLight<double>(grid, medium, {&down, 1}, {.strength = 1});
    for (int y : {0, 5, 23})
        EXPECT_NEAR(light.visible[grid.index({7, y, 9})].x, std::exp(-extinction * (0.5 - grid.center({7, y, 9}).y)),
                    1e-9);
    EXPECT_EQ(light.visible[0].y, 1); // no second light
    EXPECT_EQ(light.visible[0].a, 1);
    EXPECT_TRUE(light.scattered.empty());
}

TEST(LightVolume, ObliqueAndNearLightsAgreeWithTheIntegral) {
    // A ball of matter: the depth along a ray has a closed form.
    const LightGrid grid = cube(64);
    const double extinction = 2, radius = 0.3;
    Medium<double> medium(grid.count());
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                if (glm::length(grid.center({x, y, z})) < radius) medium[grid.index({x, y, z})].a = extinction;
    const PlacedLight lights[] = {{false, glm::normalize(glm::dvec3(0.5, 0.7, -0.3)), glm::dvec3(1)},
                                  {true, {0.2, 1.5, 0.4}, glm::dvec3(1)}};
    const LightVolume<double> light = spreadLight<double>(grid, medium, lights, {.strength = 1});
    double sum = 0; // far from the ball a sweep has blurred the outline of its shadow
    int count = 0;
    for (int z = 0; z < 64; z += 3)
        for (int y = 0; y < 64; y += 3)
            for (int x = 0; x < 64; x += 3) {
                const glm::dvec3 p = grid.center({x, y, z});
                for (int i = 0; i < 2; ++i) {
                    const glm::dvec3 way = lights[i].point ? glm::normalize(lights[i].place - p) : lights[i].place;
                    const double b = glm::dot(p, way), root = b * b - glm::dot(p, p) + radius * radius;
                    // Near the outline the grid is too coarse for the closed form.
                    if (std::abs(root) < 0.02) continue;
                    const double inside =
                        root < 0 ? 0 : std::max(0.0, -b + std::sqrt(root)) - std::max(0.0, -b - std::sqrt(root));
                    const double apart =
                        std::abs(light.visible[grid.index({x, y, z})][i] - std::exp(-extinction * inside));
                    EXPECT_LT(apart, 0.1) << x << ' ' << y << ' ' << z << " light " << i;
                    sum += apart;
                    ++count;
                }
            }
    EXPECT_LT(sum / count, 0.01);
}

TEST(LightVolume, OcclusionDarkensHollowsAndNotPlainFaces) {
    // A thick floor with a shaft.
    const LightGrid grid = cube(32);
    Medium<double> medium(grid.count());
    for (int z = 0; z < 32; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 32; ++x)
                if (std::abs(x - 16) > 2 || std::abs(z - 16) > 2) medium[grid.index({x, y, z})].a = 200;
    const LightVolume<double> light = spreadLight<double>(grid, medium, {}, {.occlusion = 1, .reach = 0.2f});
    EXPECT_GT(light.visible[grid.index({5, 17, 5})].a, 0.85); // on the floor
    EXPECT_EQ(light.visible[grid.index({5, 31, 5})].a, 1);
    EXPECT_LT(light.visible[grid.index({16, 6, 16})].a, 0.3); // down the shaft
    EXPECT_LT(light.visible[grid.index({5, 5, 5})].a, 0.01);  // within
}

TEST(LightVolume, TranslucentMatterPassesOnItsColor) {
    const LightGrid grid = cube(24);
    const Medium<double> medium(grid.count(), {4, 2, 0, 4}); // red passes, green half, blue not
    const PlacedLight down{false, {0, 1, 0}, {0.5, 1, 1}};
    const Shadows shadows{.translucency = 1, .scatter = 0};
    const LightVolume<double> light = spreadLight<double>(grid, medium, {&down, 1}, shadows);
    const glm::ivec3 at(8, 6, 8);
    const double depth = 0.5 - grid.center(at).y;
    const glm::dvec3 got = light.scattered[grid.index(at)];
    EXPECT_NEAR(got.r, 0.5 * (1 - std::exp(-4 * depth)), 1e-9);
    EXPECT_NEAR(got.g, std::exp(-2 * depth) - std::exp(-4 * depth), 1e-9);
    EXPECT_NEAR(got.b, 0, 1e-12);
    // Spreading moves light aside but makes none.
    Medium<double> half = medium;
    for (int z = 0; z < 24; ++z)
        for (int y = 12; y < 24; ++y)
            for (int x = 12; x < 24; ++x) half[grid.index({x, y, z})] = {0, 0, 0, 80};
    const auto rowAt = [&](double scatter) {
        return spreadLight<double>(grid, half, {&down, 1}, {.translucency = 1, .scatter = float(scatter)});
    };
    EXPECT_GT(rowAt(1).scattered[grid.index({13, 2, 12})].r, rowAt(0).scattered[grid.index({13, 2, 12})].r + 0.01);
}

TEST(LightVolume, SinglePrecisionIsEnough) {
    const LightGrid grid = cube(20);
    Medium<double> exact(grid.count());
    Medium<float> single;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        exact[i] = glm::dvec4(0.5, 0.25, 0.125, 1) * double(i * 7919 % 13);
        single.emplace_back(exact[i]);
    }
    const PlacedLight lights[] = {{false, glm::normalize(glm::dvec3(1, 2, 3)), glm::dvec3(1)},
                                  {true, {0.1, 0.9, 0.2}, glm::dvec3(1)}};
    const Shadows shadows{.strength = 1, .occlusion = 1, .translucency = 0.7f};
    const auto a = spreadLight<double>(grid, exact, lights, shadows);
    const auto b = spreadLight<float>(grid, single, lights, shadows);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_NEAR(glm::length(a.visible[i] - glm::dvec4(b.visible[i])), 0, 1e-5);
        EXPECT_NEAR(glm::length(a.scattered[i] - glm::dvec3(b.scattered[i])), 0, 1e-5);
    }
    EXPECT_NEAR(glm::length(a.visibleAt(grid.center({3, 4, 5})) - a.visible[grid.index({3, 4, 5})]), 0, 1e-12);
}

} // namespace
} // namespace tessera::vis
