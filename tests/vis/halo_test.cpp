#include "vis/processor/rasterized.h"

#include <gtest/gtest.h>
#include <numbers>

/// Halos: what lies behind a line or a mesh ends beside it, and nothing else changes.
namespace tessera::vis {
namespace {

constexpr glm::ivec2 kHaloSize{100, 100};
constexpr glm::vec3 kHaloColor{0.9f, 0.1f, 0.2f};

/// A cube of edge 10 seen along -z, 10 pixels for each length.
struct HaloScene {
    Scene scene;
    volume::DatasetInfo info;

    HaloScene() {
        info.lattice.size = glm::ivec3(11);
        info.bounds = {glm::dvec3(0), glm::dvec3(10)};
        info.parameters.resize(1);
        info.parameters[0].name = "v";
        info.parameters[0].ranges = {{0, 1}};
        scene.camera.projection = Projection::Orthographic;
        scene.camera.orientation = {1, 0, 0, 0};
        scene.lighting.ambient = 1;
        scene.lighting.diffuse = scene.lighting.specular = 0;
        fit();
    }
    void fit() { // the world's edge of 1 fills the height
        for (int i = 0; i < 4; ++i) scene.camera.distance /= float(pixelAtDepthOne(scene.camera, kHaloSize) * 100);
    }
    /// The nearest surface of a pixel, linear; nothing: opacity 0.
    std::vector<glm::vec4> nearest() const {
        const packet::PacketGeometry drawn = rasterized(scene, info, {}, kHaloSize, glm::dvec2(0));
        std::vector<glm::vec4> out;
        for (std::size_t i = 0; i < 10000; ++i)
            out.emplace_back(drawn.color[4 * i], drawn.color[4 * i + 1], drawn.color[4 * i + 2],
                             drawn.color[4 * i + 3]);
        return out;
    }
};

bool isHalo(glm::vec4 pixel) {
    const glm::dvec3 halo = linearFromSrgb(glm::dvec3(kHaloColor));
    return pixel.a == 1 && glm::distance(glm::dvec3(pixel), halo) < 1e-6;
}

TEST(Halo, ALineBehindEndsBesideTheOneBeforeIt) {
    HaloScene one;
    EXPECT_NEAR(pixelAtDepthOne(one.scene.camera, kHaloSize), 0.01, 1e-6);
    auto lines = std::make_shared<Geometry>();
    lines->lines.positions = {{0, 5, 8}, {10, 5, 8}, {5, 0, 2}, {5, 10, 2}}; // along x before one along y
    lines->lines.ends = {2, 4};
    const GeometryLayer layer{.geometry = lines, .style = {.color = {0, 0, 0}, .lineWidth = 4, .halo = 6}};
    one.scene.geometry = {layer};
    const auto bare = one.nearest();
    one.scene.geometry = withHalos({layer}, kHaloColor);
    ASSERT_EQ(one.scene.geometry.size(), 2u);
    const auto haloed = one.nearest();
    for (int y = 0; y < 100; ++y) {
        const glm::vec4 pixel = haloed[std::size_t(y * 100 + 50)]; // on the line behind
        const double away = std::abs(y + 0.5 - 50);
        EXPECT_EQ(isHalo(pixel), away > 2 && away < 8) << y;
        if (away < 2 || away > 8) {
            EXPECT_EQ(pixel, bare[std::size_t(y * 100 + 50)]) << y;
        }
    }
    EXPECT_TRUE(isHalo(haloed[20 * 100 + 55])) << "the line behind has its own";
    EXPECT_EQ(haloed[20 * 100 + 65].a, 0);
}

TEST(Halo, AMeshHasARimAndIsSeenAsBefore) {
    HaloScene one;
    auto ball = std::make_shared<Geometry>();
    constexpr int kRound = 48, kUp = 24;
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i <= kRound; ++i) {
            const double along = 2 * std::numbers::pi * i / kRound, up = std::numbers::pi * j / kUp;
            const glm::dvec3 way(std::sin(up) * std::cos(along), std::cos(up), std::sin(up) * std::sin(along));
            ball->mesh.positions.emplace_back(glm::dvec3(5) + way * 2.0);
            ball->mesh.normals.emplace_back(way);
        }
    for (std::uint32_t j = 0; j < kUp; ++j)
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const std::uint32_t a = j * (kRound + 1) + i, b = a + kRound + 1;
            ball->mesh.triangles.push_back({a, b, a + 1});
            ball->mesh.triangles.push_back({a + 1, b, b + 1});
        }
    const GeometryLayer layer{.geometry = ball, .style = {.color = {0, 0, 0}, .halo = 5}};
    one.scene.geometry = {layer};
    const auto bare = one.nearest();
    one.scene.geometry = withHalos({layer}, kHaloColor);
    const auto haloed = one.nearest();
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const double away = glm::length(glm::dvec2(x + 0.5, y + 0.5) - 50.0);
            const std::size_t i = std::size_t(y * 100 + x);
            if (away < 19.5) {
                EXPECT_EQ(haloed[i], bare[i]) << x << " " << y;
            }
            if (away > 20.5 && away < 24.5) {
                EXPECT_TRUE(isHalo(haloed[i])) << x << " " << y;
            }
            if (away > 25.5) {
                EXPECT_EQ(haloed[i].a, 0) << x << " " << y;
            }
        }
}

} // namespace
} // namespace tessera::vis
