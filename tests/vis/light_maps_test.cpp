#include "vis/optics/light_maps.h"
#include "vis/optics/shade.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

glm::dvec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> number;
    return glm::normalize(glm::dvec3(number(random), number(random), number(random)));
}

TEST(LightMaps, CubeTexelsCoverTheSphereAndAreFoundAgain) {
    CubeMap map;
    map.edge = 9;
    map.texels.resize(6 * 81);
    double sum = 0;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        map.texels[i] = map.texelDirection(i);
        sum += map.solidAngle(i);
    }
    EXPECT_NEAR(sum, 4 * 3.14159265358979, 0.05);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        EXPECT_NEAR(glm::length(map.at(map.texelDirection(i)) - map.texels[i]), 0, 1e-9);
    // A smooth map is smooth across edges and corners too.
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 d = randomDirection(random);
        EXPECT_NEAR(glm::length(map.at(d) - d), 0, 0.08);
    }
}

TEST(LightMaps, ManyLightsLookAlmostAsTheyDoOneByOne) {
    std::mt19937 random(5);
    for (const LightModel model : {LightModel::Phong, LightModel::Physical}) {
        Lighting lighting;
        lighting.model = model;
        lighting.shininess = 20;
        lighting.roughness = 0.6f;
        lighting.lights.clear();
        for (int i = 0; i < 8; ++i)
            lighting.lights.push_back({.kind = LightKind::World,
                                       .color = {1, 0.2f * float(i % 4), 0.5f},
                                       .intensity = 0.2f,
                                       .azimuth = 40.0f * float(i) - 160,
                                       .elevation = 15.0f * float(i % 5)});
        const Illumination direct = illuminate(lighting, {});
        lighting.inMaps = true;
        const Illumination maps = illuminate(lighting, {});
        EXPECT_TRUE(maps.lights.empty());
        double worst = 0, mean = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 normal = randomDirection(random);
            glm::dvec3 viewer = randomDirection(random);
            if (glm::dot(viewer, normal) < 0) viewer = -viewer;
            if (glm::dot(viewer, normal) < 0.5) continue; // the mirrored lobe is a lobe of (n.h) away from the edge
            const glm::dvec3 a = shade(direct, {0.5, 0.6, 0.7}, normal, 1, {}, viewer);
            const glm::dvec3 b = shade(maps, {0.5, 0.6, 0.7}, normal, 1, {}, viewer);
            worst = std::max(worst, glm::length(a - b));
            mean += glm::length(a) / 300;
        }
        EXPECT_GT(mean, 0.1);
        EXPECT_LT(worst, 0.15) << int(model);
    }
}

TEST(LightMaps, EvenSurroundingsGiveEvenLight) {
    Lighting lighting;
    lighting.environment.kind = Environment::SoftBox;
    lighting.model = LightModel::Physical;
    for (const float roughness : {0.05f, 0.3f, 1.0f}) {
        lighting.roughness = roughness;
        const LightMaps maps = environmentMaps(lighting);
        std::mt19937 random(7);
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 d = randomDirection(random);
            // Between the darkest and the brightest of what is around, brighter above; a polished surface mirrors it.
            for (const CubeMap* map : {&maps.diffuse, &maps.specular}) {
                EXPECT_GE(map->at(d).x, 0.23);
                EXPECT_LE(map->at(d).x, 0.93);
            }
            if (roughness < 0.1f) {
                EXPECT_NEAR(maps.specular.at(d).x, surroundings(lighting.environment.kind, d).x, 0.05);
            }
        }
        EXPECT_GT(maps.diffuse.at({0, 1, 0}).x, maps.diffuse.at({0, -1, 0}).x + 0.3);
    }
}

// The powers of very many directions are looked up; here they are computed.
TEST(LightMaps, AHighlightIsTheSumOverWhatIsAround) {
    for (const float shininess : {4.0f, 30.0f, 400.0f}) {
        Lighting lighting;
        lighting.environment.kind = Environment::Studio;
        lighting.shininess = shininess;
        const CubeMap found = environmentMaps(lighting).specular;
        CubeMap around;
        around.edge = kSurroundingsEdge;
        for (const std::size_t i : {std::size_t(0), std::size_t(777), found.texels.size() - 40}) {
            const glm::dvec3 mirrored = found.texelDirection(i);
            double weights = 1e-3;
            glm::dvec3 sum = weights * surroundings(Environment::Studio, mirrored);
            for (std::size_t k = 0; k < 6 * kSurroundingsEdge * kSurroundingsEdge; ++k) {
                const double along = std::max(glm::dot(mirrored, around.texelDirection(k)), 0.0);
                const double weight = std::pow(along, shininess / 4) * around.solidAngle(k);
                sum += weight * surroundings(Environment::Studio, around.texelDirection(k));
                weights += weight;
            }
            const glm::dvec3 wanted = double(lighting.environment.reflection) * sum / weights;
            EXPECT_NEAR(glm::length(found.texels[i] - wanted), 0, 1e-5 * glm::length(wanted)) << shininess;
        }
    }
}

TEST(LightMaps, SurroundingsDoNotGlare) {
    for (const Environment kind : {Environment::Sky, Environment::Studio, Environment::SoftBox}) {
        Lighting lighting;
        lighting.environment.kind = kind;
        double brightest = 0;
        for (const glm::dvec3& texel : environmentMaps(lighting).diffuse.texels)
            brightest = std::max(brightest, (texel.x + texel.y + texel.z) / 3);
        EXPECT_NEAR(brightest, 0.8, 0.12) << kEnvironmentNames[std::size_t(kind)];
    }
}

TEST(LightMaps, SkiesAndStudiosAreBrightWhereTheirLightsAre) {
    const auto bluer = [](glm::dvec3 light) { return light.b / light.r; };
    const auto sky = [](glm::dvec3 to) { return surroundings(Environment::Sky, glm::normalize(to)); };
    EXPECT_GT(bluer(sky({0, 1, 0})), 2) << "overhead";
    EXPECT_LT(bluer(sky({1, 0.1, 0})), bluer(sky({1, 0.6, 0}))) << "paler towards the horizon";
    EXPECT_LT(bluer(sky({1, -0.5, 0})), 0.9) << "the ground";
    for (const double down : {-1.0, -0.3, -0.05, 0.0}) EXPECT_GT(sky({1, down, 0}).g, 0.1) << "a number everywhere";
    EXPECT_GT(sky({-0.5, 0.7, 0.5}).g, 5) << "the sun";
    const auto studio = [](glm::dvec3 to) { return surroundings(Environment::Studio, glm::normalize(to)); };
    const double between = studio({-0.3, -0.8, 0.2}).g;
    EXPECT_GT(studio({-0.8, 0.7, 0.8}).g, between + 2) << "the key light";
    EXPECT_GT(studio({1, 0.2, 0.5}).g, between + 0.5) << "the fill light";
    EXPECT_GT(bluer(studio({1, 0.2, 0.5})), bluer(studio({-0.8, 0.7, 0.8})));
    EXPECT_GT(studio({0.3, 0.6, -1}).g, between + 1.5) << "the light from behind";
}

TEST(LightMaps, SurroundingsThatFollowTurnWithTheViewer) {
    Lighting lighting;
    lighting.environment = {.kind = Environment::Studio, .follows = true};
    Camera camera;
    const glm::dmat3 fromWorld = mapFromWorld(lighting, camera);
    const glm::dvec3 toViewer = glm::conjugate(glm::dquat(camera.orientation)) * glm::dvec3(0, 0, 1);
    EXPECT_NEAR(glm::length(fromWorld * toViewer - glm::dvec3(0, 0, 1)), 0, 1e-6);
    lighting.environment.follows = false;
    lighting.environment.turn = 90;
    EXPECT_NEAR(std::abs((mapFromWorld(lighting, camera) * glm::dvec3(0, 0, 1)).x), 1, 1e-12);
}

} // namespace
} // namespace tessera::vis
