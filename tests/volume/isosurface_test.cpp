#include "volume/mesh/isosurface.h"

#include "tests/volume/fields.h"
#include "volume/mesh/crossed_edges.h"
#include "volume/mesh/cube_cases.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tbb/global_control.h>

namespace tessera::volume {
namespace {

/// What the connections of a mesh say of its shape.
struct Topology {
    std::size_t borderEdges = 0, wrongEdges = 0; ///< used by one triangle; used otherwise than once in each direction
    long euler = 0;                              ///< vertices - edges + triangles
    double volume = 0, area = 0;                 ///< volume of closed meshes, positive when triangles face outwards
    std::vector<std::pair<std::uint32_t, std::uint32_t>> border;
};
Topology topologyOf(const SurfaceMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    Topology out;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) ++directed[{t[i], t[(i + 1) % 3]}];
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        out.volume += glm::dot(a, glm::cross(b, c)) / 6;
        out.area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, count] : directed) {
        edges.insert(std::minmax(edge.first, edge.second));
        const auto back = directed.find({edge.second, edge.first});
        if (count != 1 || edge.first == edge.second) ++out.wrongEdges;
        if (back == directed.end()) {
            ++out.borderEdges;
            out.border.push_back(edge);
        }
    }
    out.euler = long(mesh.positions.size()) - long(edges.size()) + long(mesh.triangles.size());
    return out;
}

template <class Function> SampleGrid gridOf(const Lattice& lattice, const Function& value) {
    SampleGrid grid{lattice, {}, {}};
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i)
                grid.values.push_back(static_cast<float>(value(lattice.position({i, j, k}))));
    return grid;
}

Lattice latticeOf(LatticeKind kind, glm::ivec3 size, glm::dvec3 spacing = glm::dvec3(1),
                  glm::dvec3 origin = glm::dvec3(0)) {
    const Lattice cc = test::ccLattice(size, spacing, origin);
    return kind == LatticeKind::CC ? cc : bccFor(cc);
}

class Isosurface : public ::testing::TestWithParam<LatticeKind> {};
INSTANTIATE_TEST_SUITE_P(Lattices, Isosurface, ::testing::Values(LatticeKind::CC, LatticeKind::BCC),
                         [](const auto& one) { return std::string(kLatticeNames[std::size_t(one.param)]); });

TEST_P(Isosurface, OfASphereIsClosedAndFacesLowerValues) {
    const glm::dvec3 spacing(0.5, 0.25, 0.4), origin(10, -20, 3), centre = origin + spacing * 15.3;
    const double radius = 3;
    const auto value = [&](glm::dvec3 p) { return radius - glm::length(p - centre); };
    const SurfaceMesh mesh =
        extractIsosurface(gridOf(latticeOf(GetParam(), {32, 40, 36}, spacing, origin), value), 0.75);
    const Topology found = topologyOf(mesh);
    EXPECT_GT(mesh.triangles.size(), 1000u);
    EXPECT_EQ(found.wrongEdges, 0u);
    EXPECT_EQ(found.borderEdges, 0u);
    EXPECT_EQ(found.euler, 2);
    const double wanted = 4.0 / 3 * std::numbers::pi * std::pow(radius - 0.75, 3);
    EXPECT_NEAR(found.volume, wanted, 0.02 * wanted);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 out = glm::dvec3(mesh.positions[i]) - centre;
        EXPECT_NEAR(glm::length(out), radius - 0.75, 0.03);
        EXPECT_GT(glm::dot(glm::dvec3(mesh.normals[i]), glm::normalize(out)), 0.99);
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5);
    }
}

TEST_P(Isosurface, OfATorusHasOneHole) {
    const auto value = [](glm::dvec3 p) {
        const glm::dvec3 q = p - glm::dvec3(20.2, 20.1, 12.3);
        return 5 - std::hypot(std::hypot(q.x, q.y) - 11, q.z);
    };
    const Topology found = topologyOf(extractIsosurface(gridOf(latticeOf(GetParam(), {41, 41, 25}), value), 0));
    EXPECT_EQ(found.wrongEdges, 0u);
    EXPECT_EQ(found.borderEdges, 0u);
    EXPECT_EQ(found.euler, 0);
}

// Noise meets every case of a cell, also the ambiguous ones, and samples that equal the value.
TEST_P(Isosurface, OfNoiseEndsAtTheBorderOnly) {
    std::mt19937 random(7);
    for (const int levels : {2, 4, 1000}) {
        std::uniform_int_distribution<int> any(0, levels - 1);
        const Lattice lattice = latticeOf(GetParam(), {70, 12, 11});
        const SampleGrid grid = gridOf(lattice, [&](glm::dvec3) { return any(random); });
        const SurfaceMesh mesh = extractIsosurface(grid, levels / 2);
        const Topology found = topologyOf(mesh);
        EXPECT_EQ(found.wrongEdges, 0u) << levels;
        // A lattice point further inside has all its cells.
        const glm::dvec3 lo = lattice.origin + lattice.spacing * 0.999,
                         hi = lattice.position(lattice.size - 1) - lattice.spacing * 0.999;
        const double reach = GetParam() == LatticeKind::CC ? 0.999 : 0;
        for (const auto& [a, b] : found.border)
            for (const std::uint32_t v : {a, b}) {
                const glm::dvec3 p(mesh.positions[v]);
                const bool inner = glm::all(glm::greaterThan(p, lo - reach)) && glm::all(glm::lessThan(p, hi + reach));
                EXPECT_FALSE(inner) << p.x << ' ' << p.y << ' ' << p.z;
            }
    }
}

// The outer layer below the value everywhere: nothing may be open, whatever the cells inside are.
TEST_P(Isosurface, OfWrappedNoiseIsWatertight) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1, 1);
    const Lattice lattice = latticeOf(GetParam(), {40, 30, 30});
    const glm::dvec3 lo = lattice.origin + lattice.spacing * 1.2,
                     hi = lattice.position(lattice.size - 1) - lattice.spacing * 1.2;
    const SampleGrid grid = gridOf(lattice, [&](glm::dvec3 p) {
        const bool inner = glm::all(glm::greaterThan(p, lo)) && glm::all(glm::lessThan(p, hi));
        return inner ? any(random) : -1;
    });
    const Topology found = topologyOf(extractIsosurface(grid, 0.1));
    EXPECT_EQ(found.wrongEdges, 0u);
    EXPECT_EQ(found.borderEdges, 0u);
    EXPECT_EQ(found.euler % 2, 0);
    EXPECT_GT(found.volume, 0);
}

TEST_P(Isosurface, StopsAtAbsentSamples) {
    const Lattice lattice = latticeOf(GetParam(), {24, 24, 24});
    SampleGrid grid = gridOf(lattice, [](glm::dvec3 p) { return p.z + 0.1 * p.x; });
    grid.present.assign(grid.values.size(), 1);
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i)
                if (lattice.position({i, j, k}).x > 12.1) {
                    grid.present[lattice.index({i, j, k})] = 0;
                    grid.values[lattice.index({i, j, k})] = -1e9f; // must never show
                }
    const SurfaceMesh mesh = extractIsosurface(grid, 12.3);
    const Topology found = topologyOf(mesh);
    EXPECT_EQ(found.wrongEdges, 0u);
    EXPECT_EQ(found.euler, 1); // a disc
    float reach = 0;
    std::vector<bool> used(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) used[t[i]] = true;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_TRUE(used[i]);
        const glm::vec3 p = mesh.positions[i];
        reach = std::max(reach, p.x);
        EXPECT_LE(p.x, 12.1f);
        EXPECT_NEAR(p.z + 0.1 * p.x, 12.3, 1e-4); // no spikes
        EXPECT_NEAR(mesh.normals[i].z, -1 / std::hypot(1, 0.1), 0.02);
        EXPECT_NEAR(mesh.normals[i].x, -0.1 / std::hypot(1, 0.1), 0.02);
    }
    EXPECT_GT(reach, 10.5f);
}

// The plane fills the box exactly, also on BCC, whose outermost samples lie in zigzag.
TEST_P(Isosurface, IsCutAtTheBox) {
    const glm::ivec3 size(13, 11, 17);
    const Box box{glm::dvec3(0), glm::dvec3(size - 1)};
    const auto value = [](glm::dvec3 p) { return p.x; };
    const SurfaceMesh mesh = extractIsosurface(gridOf(latticeOf(GetParam(), size), value), 5.2, box);
    const Topology found = topologyOf(mesh);
    EXPECT_EQ(found.wrongEdges, 0u);
    EXPECT_EQ(found.euler, 1);
    EXPECT_NEAR(found.area, 10 * 16, 0.01);
    for (const auto& [a, b] : found.border) {
        const glm::vec3 p = mesh.positions[a];
        const bool onFace = p.y == 0 || p.z == 0 || p.y == 10 || p.z == 16;
        EXPECT_TRUE(onFace) << p.y << ' ' << p.z;
    }
}

TEST_P(Isosurface, DoesNotDependOnThreads) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    const SampleGrid grid = gridOf(latticeOf(GetParam(), {50, 40, 40}), [&](glm::dvec3) { return any(random); });
    const Box box{glm::dvec3(0.3), glm::dvec3(38.6)};
    const SurfaceMesh many = extractIsosurface(grid, 0.5, box);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(extractIsosurface(grid, 0.5, box), many);
}

TEST_P(Isosurface, OfNothingIsEmpty) {
    const SampleGrid flat = gridOf(latticeOf(GetParam(), {9, 9, 9}), [](glm::dvec3) { return 1; });
    EXPECT_TRUE(extractIsosurface(flat, 2).triangles.empty());
    EXPECT_TRUE(extractIsosurface(flat, 0, Box{glm::dvec3(1), glm::dvec3(5)}).positions.empty());
    const SampleGrid single = gridOf(latticeOf(GetParam(), {1, 1, 1}), [](glm::dvec3) { return 1; });
    EXPECT_TRUE(extractIsosurface(single, 0.5).triangles.empty());
}

TEST_P(Isosurface, OfASourceLiesInPlaceAtEveryLevel) {
    const Lattice cc = test::ccLattice({50, 40, 44}, {0.1, 0.2, 0.3}, {5, 6, 7});
    const glm::dvec3 centre = test::boxOf(cc).center();
    const auto value = [&](glm::dvec3 p) { return 4 - glm::length((p - centre) / glm::dvec3(0.5, 0.8, 1.3)); };
    Dataset data = test::datasetOf(
        {test::sampled<float>(cc, value), test::sampled<float>(cc, [](glm::dvec3 p) { return p.x + 2 * p.y - p.z; })});
    const auto source = makeMemorySource(std::move(data), {.lattice = GetParam(), .brickSize = 16});
    for (const int level : {0, 1, 2}) {
        SurfaceMesh mesh = extractIsosurface(*source, 0, 0, 1.5, level);
        const Topology found = topologyOf(mesh);
        EXPECT_EQ(found.wrongEdges, 0u);
        EXPECT_EQ(found.borderEdges, 0u);
        EXPECT_EQ(found.euler, 2);
        double worst = 0;
        for (const glm::vec3& p : mesh.positions) worst = std::max(worst, std::abs(value(glm::dvec3(p)) - 1.5));
        EXPECT_LT(worst, level == 0 ? 0.05 : level == 1 ? 0.1 : 0.3) << level;
        if (level > 0) continue;
        sampleAtVertices(mesh, *source, 1, 0, 0);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::vec3 p = mesh.positions[i];
            EXPECT_NEAR(mesh.scalars[i], p.x + 2 * p.y - p.z, 1e-3);
        }
    }
}

// Of a linear function the gradient is exact as long as three diagonals of a sample of BCC have an end each.
TEST(SampleGradient, NeedsThreeDiagonals) {
    const Lattice lattice{LatticeKind::BCC, {5, 5, 10}, glm::dvec3(1), glm::dvec3(0)};
    const glm::dvec3 slope(2, -3, 0.5);
    const SampleGrid all = gridOf(lattice, [&](glm::dvec3 p) { return glm::dot(slope, p); });
    for (const int z : {4, 5})
        for (int lost = 0; lost < 4; ++lost) {
            const glm::ivec3 at(2, 2, z);
            SampleGrid grid = all;
            grid.present.assign(grid.values.size(), 1);
            for (int n = 0; n < int(grid.values.size()); ++n) {
                const glm::ivec3 other(n % lattice.size.x, n / lattice.size.x % lattice.size.y,
                                       n / (lattice.size.x * lattice.size.y));
                // Along this diagonal both are gone, along the others one is.
                const glm::dvec3 away = lattice.position(other) - lattice.position(at);
                const glm::dvec3 lostDiagonal(lost & 1 ? 0.5 : -0.5, lost & 2 ? 0.5 : -0.5, 0.5);
                if (std::abs(away.z) != 0.5) continue;
                const bool gone = away == lostDiagonal || away == -lostDiagonal || away.z < 0;
                grid.present[std::size_t(n)] = gone ? 0 : 1;
            }
            const glm::vec3 got = sampleGradient(grid, at);
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(got[axis], slope[axis], 1e-5) << z << " " << lost;
        }
}

TEST(CubeCases, UseEachCrossedEdgeAndNoOther) {
    for (int inside = 0; inside < 256; ++inside)
        for (int joined = 0; joined < 64; ++joined) {
            if ((joined & ~ambiguousFaces(inside)) != 0) continue;
            std::set<int> used;
            for (const auto& triangle : cubeCase(inside, std::uint8_t(joined)).triangles)
                for (const int n : triangle)
                    if (n < kFirstCentre) used.insert(n);
            for (int edge = 0; edge < 12; ++edge) {
                const int a = edgeCorner(edge), b = a | 1 << edge / 4;
                EXPECT_EQ(used.contains(edge), (inside >> a & 1) != (inside >> b & 1)) << inside << ' ' << edge;
            }
        }
}

// A sphere of 1.5 m in geographic coordinates, where 32 bits hold half metres, beside the same one at 0.
TEST(MeshOrigin, FarFromZeroASurfaceIsTheSame) {
    const glm::dvec3 far(500000.3, 5000000.7, 120.1);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool cut : {false, true}) {
            const auto sphereAt = [&](glm::dvec3 centre) {
                const Lattice lattice = latticeOf(kind, {17, 17, 17}, glm::dvec3(0.25), centre - 2.0);
                const SampleGrid grid = gridOf(lattice, [&](glm::dvec3 p) { return 1.5 - glm::distance(p, centre); });
                const Box box{centre - glm::dvec3(1.3, 2, 2), centre + 2.0};
                return extractIsosurface(grid, 0, cut ? std::optional(box) : std::nullopt);
            };
            const SurfaceMesh near = sphereAt(glm::dvec3(0)), away = sphereAt(far);
            EXPECT_EQ(near.origin, glm::dvec3(0));
            EXPECT_EQ(away.origin, glm::dvec3(cut ? 500001 : 500000, 5000001, 120)) << "a round number near the middle";
            ASSERT_EQ(near.positions.size(), away.positions.size());
            double worst = 0;
            for (std::size_t i = 0; i < near.positions.size(); ++i)
                worst = std::max(worst, glm::distance(placeOf(away, i) - far, placeOf(near, i)));
            EXPECT_LT(worst, 1e-5) << "metres; of 32 bits 0.25";
            EXPECT_NEAR(topologyOf(away).area, topologyOf(near).area, 1e-5);
            if (!cut) {
                EXPECT_NEAR(topologyOf(away).volume, topologyOf(near).volume, 1e-4);
            }
        }
}

TEST(MeshOrigin, IsOnlyUsedFarAway) {
    EXPECT_EQ(originFor({{1, 2, 3}, {4, 5, 6}}), glm::dvec3(0));
    EXPECT_EQ(originFor({{-100, 0, 40}, {-93, 0, 40}}), glm::dvec3(0));
    EXPECT_EQ(originFor({{-1000, 0, 40}, {-993, 0, 40}}), glm::dvec3(-997, 0, 40));
    EXPECT_EQ(originFor({{4e6, 0, 0}, {4e6 + 2500, 0, 0}}), glm::dvec3(4001000, 0, 0));
    EXPECT_EQ(originFor({{5, 5, 5}, {5, 5, 5}}), glm::dvec3(0)) << "of no extent";
}

} // namespace
} // namespace tessera::volume
