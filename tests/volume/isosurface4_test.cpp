#include "volume/four/isosurface4.h"

#include "tests/volume/fields.h"
#include "tests/volume/uneven.h"
#include "volume/four/hyperplane_cut.h"
#include "volume/four/tetra_file.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace tessera::volume {
namespace {

template <class Value> SampleGrid gridOfValues(const Lattice& lattice, const Value& value) {
    SampleGrid grid{lattice, {}, {}};
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i)
                grid.values.push_back(static_cast<float>(value(lattice.position({i, j, k}))));
    return grid;
}

template <class Value>
TetraMesh surfaceOf(const Lattice& lattice, const std::vector<double>& times, double at, const Value& value) {
    return extractIsosurface4(
        times,
        [&](int time) {
            return gridOfValues(lattice, [&](glm::dvec3 place) { return value(place, times[std::size_t(time)]); });
        },
        at);
}

/// Volume within triangles that face outwards.
double volumeWithin(const SurfaceMesh& mesh) {
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto at = [&](int i) { return mesh.origin + glm::dvec3(mesh.positions[t[i]]); };
        volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    return volume;
}

/// How often each face of the tetrahedra is used.
std::map<std::array<std::uint32_t, 3>, int> facesOf(const TetraMesh& mesh) {
    std::map<std::array<std::uint32_t, 3>, int> faces;
    for (const glm::uvec4& t : mesh.tetrahedra)
        for (int skip = 0; skip < 4; ++skip) {
            std::array<std::uint32_t, 3> face{};
            for (int i = 0, n = 0; i < 4; ++i)
                if (i != skip) face[std::size_t(n++)] = t[i];
            std::ranges::sort(face);
            ++faces[face];
        }
    return faces;
}

std::vector<double> evenTimes(int count, double from, double step) {
    std::vector<double> times;
    for (int i = 0; i < count; ++i) times.push_back(from + step * i);
    return times;
}

Lattice latticeAround(LatticeKind kind, int n) {
    const Lattice cc = test::ccLattice(glm::ivec3(n), glm::dvec3(2.0 / (n - 1)), glm::dvec3(-1));
    return kind == LatticeKind::CC ? cc : bccFor(cc);
}

constexpr double kHyperRadius = 0.8;
double hypersphere(glm::dvec3 place, double time) {
    return kHyperRadius - std::sqrt(glm::dot(place, place) + time * time);
}

TEST(Isosurface4, CutsOfAHypersphereAreBallsOfTheirVolume) {
    const std::vector<double> times = evenTimes(32, -1, 2.0 / 31);
    const TetraMesh mesh = surfaceOf(latticeAround(LatticeKind::CC, 32), times, 0, hypersphere);
    for (const double time : {-0.55, -0.2, 0.01, times[16], 0.4321, 0.6}) {
        const double radius = std::sqrt(kHyperRadius * kHyperRadius - time * time);
        const double ball = 4 * std::numbers::pi / 3 * radius * radius * radius;
        EXPECT_NEAR(volumeWithin(cutAtTime(mesh, time)), ball, 0.02 * ball) << time;
    }
    EXPECT_TRUE(cutAtTime(mesh, 0.85).triangles.empty());
    // A tilted hyperplane through the middle: a ball, too, in its own three dimensions.
    const glm::dvec4 normal(0.5, -0.5, 0.5, 0.5);
    const TriangleMesh4 cut = cutByHyperplane(mesh, normal, 0.1);
    double content = 0;
    for (const glm::uvec3& t : cut.triangles) {
        const glm::dvec4 middle = 0.1 * normal;
        const auto at = [&](int i) { return cut.points[t[i]] - middle; };
        content += glm::determinant(glm::dmat4(at(0), at(1), at(2), normal)) / 6;
    }
    const double radius = std::sqrt(kHyperRadius * kHyperRadius - 0.01);
    EXPECT_NEAR(content, 4 * std::numbers::pi / 3 * std::pow(radius, 3), 0.02 * 4 * std::pow(radius, 3));
}

TEST(Isosurface4, IsClosedOnBothLattices) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const TetraMesh mesh = surfaceOf(latticeAround(kind, 18), evenTimes(11, -1, 0.2), 0, hypersphere);
        EXPECT_GT(mesh.tetrahedra.size(), 1000u);
        for (const auto& [face, count] : facesOf(mesh)) ASSERT_EQ(count, 2) << kLatticeNames[std::size_t(kind)];
        // Oriented alike: each face is used once in either direction, so that contents add up to that of the ball.
        double content = 0;
        for (const glm::uvec4& t : mesh.tetrahedra)
            content += glm::determinant(
                glm::dmat4(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
        const double ball = std::pow(std::numbers::pi, 2) / 2 * std::pow(kHyperRadius, 4);
        EXPECT_NEAR(std::abs(content) / 24, ball, 0.1 * ball) << kLatticeNames[std::size_t(kind)];
    }
}

TEST(Isosurface4, OfNoiseEndsAtTheBorderAlone) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> even(0, 1);
    const Lattice lattice = test::ccLattice({5, 6, 4});
    const std::vector<double> times{0, 1, 2, 3};
    const TetraMesh mesh = surfaceOf(lattice, times, 0.5, [&](glm::dvec3, double) { return double(even(random)); });
    const glm::dvec4 lo(0), hi(4, 5, 3, 3);
    for (const auto& [face, count] : facesOf(mesh)) {
        ASSERT_LE(count, 2);
        if (count == 2) continue;
        bool atBorder = false; // all its corners on one side of the box
        for (int axis = 0; axis < 4; ++axis)
            for (const double side : {lo[axis], hi[axis]})
                atBorder = atBorder || std::ranges::all_of(face, [&](std::uint32_t point) {
                               return std::abs(mesh.points[point][axis] - side) < 1e-9;
                           });
        ASSERT_TRUE(atBorder);
    }
}

TEST(Isosurface4, VerticesLieAtTruePlacesAndTimes) {
    const Lattice lattice = test::layeredLattice(AxisMap::Of::Cells);
    const std::vector<double> times{0, 0.1, 0.5, 2};
    // Linear in space and time: every vertex lies on the surface exactly.
    const auto value = [](glm::dvec3 p, double t) { return p.x - 0.5 * p.y + 0.25 * p.z + 5e-4 * t; };
    const glm::dvec3 lo = lattice.position(glm::ivec3(0)), hi = lattice.position(lattice.size - 1);
    const double middle = 0.5 * (value(lo, 0) + value(hi, 2));
    const TetraMesh mesh = surfaceOf(lattice, times, middle, value);
    ASSERT_GT(mesh.points.size(), 100u);
    std::set<double> between;
    for (const glm::dvec4& point : mesh.points) {
        EXPECT_NEAR(value(glm::dvec3(point), point.w), middle, 1e-5 * std::abs(value(hi, 2) - value(lo, 0)));
        if (std::ranges::find(times, point.w) == times.end()) between.insert(point.w);
    }
    EXPECT_GT(between.size(), 20u);
    EXPECT_GT(*between.rbegin(), 0.6); // in the long last step too
}

/// Triangles of the surface of one time, by the same tetrahedra.
double areaByTetrahedra(const SampleGrid& grid, double value) {
    const Lattice& lattice = grid.lattice;
    double area = 0;
    std::array<int, 3> axes{0, 1, 2};
    do
        for (int z = 0; z + 1 < lattice.size.z; ++z)
            for (int y = 0; y + 1 < lattice.size.y; ++y)
                for (int x = 0; x + 1 < lattice.size.x; ++x) {
                    std::array<glm::ivec3, 4> at{glm::ivec3(x, y, z)};
                    for (std::size_t i = 0; i < 3; ++i) at[i + 1] = at[i], at[i + 1][axes[i]] += 1;
                    std::vector<glm::ivec3> in, out;
                    for (const glm::ivec3 corner : at)
                        (grid.values[lattice.index(corner)] >= value ? in : out).push_back(corner);
                    if (in.empty() || out.empty()) continue;
                    const auto cross = [&](glm::ivec3 a, glm::ivec3 b) {
                        const double from = grid.values[lattice.index(a)], to = grid.values[lattice.index(b)];
                        return glm::mix(lattice.position(a), lattice.position(b), (value - from) / (to - from));
                    };
                    const auto triangle = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
                        area += glm::length(glm::cross(b - a, c - a)) / 2;
                    };
                    if (in.size() == 2) {
                        triangle(cross(in[0], out[0]), cross(in[0], out[1]), cross(in[1], out[1]));
                        triangle(cross(in[0], out[0]), cross(in[1], out[0]), cross(in[1], out[1]));
                    } else {
                        std::vector<glm::dvec3> corners;
                        for (const glm::ivec3 a : in)
                            for (const glm::ivec3 b : out) corners.push_back(cross(a, b));
                        triangle(corners[0], corners[1], corners[2]);
                    }
                }
    while (std::ranges::next_permutation(axes).found);
    return area;
}

double trianglesArea(const SurfaceMesh& mesh) {
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

TEST(Isosurface4, AtStoredTimesItIsTheSurfaceOfThatTimeAndMovesInBetween) {
    const Lattice lattice = test::ccLattice({9, 10, 8}, {1, 0.5, 0.7});
    const std::vector<double> times{0, 1, 3};
    const auto value = [](glm::dvec3 p, double t) {
        return std::sin(0.9 * p.x + 0.3 * t) + std::cos(1.1 * p.y - 0.2 * t) + std::sin(0.8 * p.z) * (1 + 0.1 * t);
    };
    const TetraMesh mesh = surfaceOf(lattice, times, 0.4, value);
    for (const double time : times) {
        const double area =
            areaByTetrahedra(gridOfValues(lattice, [&](glm::dvec3 place) { return value(place, time); }), double(0.4f));
        EXPECT_NEAR(trianglesArea(cutAtTime(mesh, time)), area, 2e-4 * area) << time;
        if (time == 0 || time == 3) continue;
        EXPECT_NEAR(trianglesArea(cutAtTime(mesh, time - 1e-6)), area, 1e-3 * area);
        EXPECT_NEAR(trianglesArea(cutAtTime(mesh, time + 1e-6)), area, 1e-3 * area);
    }
}

TEST(Isosurface4, EndsAtAbsentSamplesAndKeepsPartsApart) {
    const Lattice lattice = test::ccLattice({8, 8, 8});
    const std::vector<double> times{0, 1, 2, 3};
    const auto read = [&](int time) { // steps of both parts: 0 to 1 across x = 3.5, parts meet at y = 3.5
        SampleGrid grid = gridOfValues(lattice, [&](glm::dvec3 p) { return p.x > 3.5 ? 1.0 : 0.0; });
        for (std::size_t i = 0; i < grid.values.size(); ++i) grid.parts.push_back(i / 8 % 8 > 3 ? 1 : 0);
        grid.present.assign(grid.values.size(), 1);
        if (time == 2)
            for (std::size_t i = 0; i < grid.values.size(); ++i)
                if (i / 64 < 4) grid.present[i] = 0;
        return grid;
    };
    const TetraMesh mesh = extractIsosurface4(times, read, 0.5);
    ASSERT_FALSE(mesh.tetrahedra.empty());
    bool below = false, above = false;
    for (const glm::uvec4& t : mesh.tetrahedra) {
        double least = 1e9, most = -1e9;
        for (int i = 0; i < 4; ++i) {
            const glm::dvec4 at = mesh.points[t[i]];
            least = std::min(least, at.y);
            most = std::max(most, at.y);
            EXPECT_TRUE(at.z > 3 || at.w <= 1 || at.w == 3) << "nothing reaches an absent sample";
        }
        EXPECT_TRUE(most <= 3 || least >= 4) << "no tetrahedron is of both parts";
        below = below || most <= 3;
        above = above || least >= 4;
    }
    EXPECT_TRUE(below && above);
}

TEST(Isosurface4, ReadsALevelOfASource) {
    std::vector<Field> fields;
    const Lattice lattice = latticeAround(LatticeKind::CC, 17);
    for (int t = 0; t < 3; ++t)
        fields.push_back(test::sampled<float>(lattice, [&](glm::dvec3 p) { return hypersphere(p, 0.2 * t); }));
    Dataset dataset = test::datasetOf(std::move(fields), 3);
    dataset.info.times = {0, 0.2, 0.4};
    const auto source = makeMemorySource(dataset, {.brickSize = 8});
    const TetraMesh fine = extractIsosurface4(*source, 0, 0, 0), coarse = extractIsosurface4(*source, 0, 0, 1);
    EXPECT_GT(fine.tetrahedra.size(), 2 * coarse.tetrahedra.size());
    EXPECT_GT(coarse.tetrahedra.size(), 100u);
    const double ball = 4 * std::numbers::pi / 3 * std::pow(kHyperRadius * kHyperRadius - 0.04, 1.5);
    EXPECT_NEAR(volumeWithin(cutAtTime(fine, 0.2)), ball, 0.04 * ball);
    EXPECT_NEAR(volumeWithin(cutAtTime(coarse, 0.2)), ball, 0.2 * ball);

    const std::string path = testing::TempDir() + "surface4.vtu";
    writeTetraMesh(coarse, path);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::remove(path.c_str());
    EXPECT_NE(bytes.find("NumberOfPoints=\"" + std::to_string(coarse.points.size()) + "\" NumberOfCells=\"" +
                         std::to_string(coarse.tetrahedra.size()) + "\""),
              std::string::npos);
    const std::size_t data = bytes.find("encoding=\"raw\">\n_") + 17;
    double time = 0;
    std::memcpy(&time, bytes.data() + data + 8, 8);
    EXPECT_EQ(time, coarse.points.front().w);
    double x = 0;
    std::memcpy(&x, bytes.data() + data + 8 + 8 * coarse.points.size() + 8, 8);
    EXPECT_EQ(x, coarse.points.front().x);
    EXPECT_THROW(writeTetraMesh(coarse, "surface.vtk"), Error);
}

} // namespace
} // namespace tessera::volume
