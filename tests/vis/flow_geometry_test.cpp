#include "vis/shapes/flow_geometry.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace tessera::vis {
namespace {

/// Every edge belongs to two triangles that run along it in opposite directions, places that coincide taken as one.
void expectClosed(const volume::SurfaceMesh& mesh) {
    const auto key = [&](std::uint32_t v) {
        const glm::vec3 p = mesh.positions[v];
        return std::array<long, 3>{std::lround(p.x * 1e4), std::lround(p.y * 1e4), std::lround(p.z * 1e4)};
    };
    std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> edges;
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const auto a = key(t[i]), b = key(t[(i + 1) % 3]);
            if (a != b) ++edges[{a, b}];
        }
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        ASSERT_TRUE(back != edges.end() && back->second == count);
    }
}

double volumeOf(const volume::SurfaceMesh& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

TEST(Tubes, AreRoundAsDrawnAndClosed) {
    LineSet lines;
    for (int i = 0; i <= 200; ++i) {
        const float angle = float(i) * 0.05f;
        lines.positions.emplace_back(std::cos(angle), std::sin(angle) / 4, float(i) * 0.01f);
        lines.scalars.push_back(float(i));
    }
    lines.ends = {201};
    const glm::dvec3 stretch(1, 4, 2);
    const double radius = 0.05;
    const volume::SurfaceMesh mesh = tubes(lines, radius, stretch);
    expectClosed(mesh);
    double worst = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        double nearest = 1e9;
        for (const glm::vec3& place : lines.positions)
            nearest =
                std::min(nearest, glm::distance(glm::dvec3(place) * stretch, glm::dvec3(mesh.positions[i]) * stretch));
        if (nearest > 1e-5) worst = std::max(worst, std::abs(nearest - radius)); // but the middles of the ends
        // The renderer's normal: divided by the stretch, outwards from the axis.
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5);
    }
    EXPECT_LT(worst, 0.002);
    EXPECT_GT(volumeOf(mesh), 0) << "faces outwards";
    EXPECT_EQ(mesh.scalars.front(), 0);
    EXPECT_EQ(mesh.scalars.back(), 200);
}

TEST(Tubes, LeaveOutWhatHasNoLength) {
    LineSet lines;
    lines.positions = {glm::vec3(1), glm::vec3(1), glm::vec3(0)};
    lines.ends = {2, 3, 3};
    EXPECT_TRUE(tubes(lines, 0.1, glm::dvec3(1)).triangles.empty());
}

TEST(Tubes, KeepTheVerticesTheyNeed) {
    // A long straight way, then a quarter of a circle, in two hundred steps each; the scalar rises evenly.
    LineSet lines;
    for (int i = 0; i <= 400; ++i) {
        const double turn = i < 200 ? 0 : 0.5 * std::numbers::pi * (i - 200) / 200;
        lines.positions.push_back(i < 200 ? glm::vec3(i * 0.01, 0, 0)
                                          : glm::vec3(2 + std::sin(turn), 1 - std::cos(turn), 0));
        lines.scalars.push_back(float(i));
    }
    lines.ends = {401};
    const double radius = 0.1;
    const volume::SurfaceMesh mesh = tubes(lines, radius, glm::dvec3(1));
    const std::size_t perRing =
        tubes({.positions = {glm::vec3(0), glm::vec3(1, 0, 0)}, .scalars = {0, 1}, .ends = {2}}, radius, glm::dvec3(1))
            .positions.size() /
        6; // two rings, and two for each end
    EXPECT_LT(mesh.positions.size(), 40 * perRing);
    EXPECT_GT(mesh.positions.size(), 8 * perRing);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 p = mesh.positions[v];
        const double away = p.x < 2 ? std::hypot(p.y, p.z) : std::hypot(std::hypot(p.x - 2, p.y - 1) - 1, p.z);
        EXPECT_LT(away, 1.2 * radius) << v;
    }
    // A scalar that jumps keeps its place although the way is straight.
    for (std::size_t i = 0; i < lines.scalars.size(); ++i) lines.scalars[i] = i < 100 ? 0.0f : 1.0f;
    const volume::SurfaceMesh jumps = tubes(lines, radius, glm::dvec3(1));
    for (std::size_t v = 0; v < jumps.positions.size(); ++v)
        if (std::abs(jumps.positions[v].x - 1) > 0.02f) {
            EXPECT_EQ(jumps.scalars[v], jumps.positions[v].x < 1 ? 0.0f : 1.0f) << v;
        }
}

TEST(Glyphs, PointAlongTheirVector) {
    const glm::dvec3 place(1, 2, 3), stretch(2, 1, 0.5);
    for (const glm::dvec3 vector : {glm::dvec3(0, 0, 3), glm::dvec3(1, -2, 0.5)}) {
        const double length = glm::length(vector);
        const Glyph glyph{place, vector, 0.25f};
        for (const bool shaft : {true, false}) {
            const volume::SurfaceMesh mesh = shaft ? arrows({{glyph}}, stretch) : cones({{glyph}}, stretch);
            expectClosed(mesh);
            EXPECT_GT(volumeOf(mesh), 0);
            double lo = 1e9, hi = -1e9, across = 0;
            for (const glm::vec3& p : mesh.positions) {
                const glm::dvec3 d = glm::dvec3(p) * stretch - place * stretch;
                const double along = glm::dot(d, vector) / length;
                lo = std::min(lo, along);
                hi = std::max(hi, along);
                across = std::max(across, glm::length(d - vector / length * along));
            }
            EXPECT_NEAR(lo, shaft ? 0 : -length / 2, 1e-5);
            EXPECT_NEAR(hi, shaft ? length : length / 2, 1e-5);
            EXPECT_LT(across, length / 4);
            for (const float scalar : mesh.scalars) EXPECT_EQ(scalar, 0.25f);
        }
    }
}

} // namespace
} // namespace tessera::vis
