#include "volume/four/space_time_surfaces.h"

#include "tests/volume/uneven.h"
#include "volume/mesh/finer_mesh.h"
#include "volume/mesh/isosurface.h"
#include "volume/sources/memory_source.h"
#include "volume/sources/time_axis.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace tessera::volume {
namespace {

using Value = std::function<double(glm::dvec3 place, double time)>;

/// Data of one parameter at those times.
std::shared_ptr<const BrickSource> dataOf(const Lattice& lattice, const std::vector<double>& times, const Value& value,
                                          LatticeKind drawn = LatticeKind::CC) {
    Dataset data;
    data.info.name = "moving";
    data.info.lattice = lattice;
    data.info.bounds = {lattice.position(glm::ivec3(0)), lattice.position(lattice.size - 1)};
    data.info.times = times;
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "f";
    data.info.parameters[0].ranges = {{-2, 2}};
    data.read = [lattice, times, value](int, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        std::size_t index = 0;
        for (int k = 0; k < lattice.size.z; ++k)
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i)
                    field.as<float>()[index++] = float(value(lattice.position({i, j, k}), times[std::size_t(time)]));
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = drawn});
}

Lattice cubeAround(int n) {
    Lattice lattice;
    lattice.size = glm::ivec3(n);
    lattice.spacing = glm::dvec3(2.0 / (n - 1));
    lattice.origin = glm::dvec3(-1);
    return lattice;
}

std::vector<double> timesAcross(int count) {
    std::vector<double> times;
    for (int i = 0; i < count; ++i) times.push_back(-1 + 2.0 * i / (count - 1));
    return times;
}

double volumeWithin(const SurfaceMesh& mesh) {
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto at = [&](int i) { return mesh.origin + glm::dvec3(mesh.positions[t[i]]); };
        volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    return volume;
}

constexpr double kRadius = 0.8;
double hypersphere(glm::dvec3 place, double time) {
    return kRadius - std::sqrt(glm::dot(place, place) + time * time);
}

TEST(SpaceTimeSurfaces, OfAHypersphereAreBallsBetweenStoredTimes) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto data = dataOf(cubeAround(32), timesAcross(32), hypersphere, kind);
        SpaceTimeSurfaces surfaces;
        for (const double time : {-0.5, -0.21, 0.013, 0.35, 0.6}) {
            const TimePair pair = timesAround(data->info().times, time);
            ASSERT_TRUE(pair.between());
            const SurfaceMesh mesh = surfaces.atTime(data, 0, 0, pair, {}, 0);
            const double radius = std::sqrt(kRadius * kRadius - time * time);
            const double ball = 4 * std::numbers::pi / 3 * std::pow(radius, 3);
            EXPECT_NEAR(volumeWithin(mesh), ball, 0.02 * ball) << time;
            EXPECT_TRUE(surfaces.keeps(data, 0, 0, pair, 0));
            for (std::size_t i = 0; i < mesh.positions.size(); ++i)
                ASSERT_GT(glm::dot(mesh.normals[i], mesh.positions[i]), 0) << "normals point to lower values";
        }
        EXPECT_FALSE(surfaces.keeps(data, 0, 0.1, {}, 0));
    }
}

// A ball that goes 0.6 of its radius between two times: its middle and its volume in between, not those of either time.
TEST(SpaceTimeSurfaces, MoveSmoothlyBetweenStoredTimes) {
    constexpr double kBall = 0.4, kSpeed = 0.25;
    const auto moving = [](glm::dvec3 p, double t) { return kBall - glm::length(p - glm::dvec3(kSpeed * t, 0, 0)); };
    const auto data = dataOf(cubeAround(41), {-2, -1, 0, 1, 2}, moving);
    SpaceTimeSurfaces surfaces;
    double last = -1;
    for (double time = -1; time <= 1; time += 0.125) {
        const SurfaceMesh mesh = surfaces.atTime(data, 0, 0, timesAround(data->info().times, time), {}, 0);
        double middle = 0;
        for (const glm::vec3& position : mesh.positions) middle += double(position.x) / double(mesh.positions.size());
        EXPECT_NEAR(middle, kSpeed * time, 0.02);
        EXPECT_GT(middle, last) << time;
        last = middle;
    }
}

TEST(SpaceTimeSurfaces, EndAtTheBoundsOfTheDataAndLieOnTheirSheet) {
    // Cells: the outermost samples lie half a cell inside of the bounds.
    Lattice lattice = cubeAround(9);
    const auto plain = dataOf(lattice, {0, 1}, [](glm::dvec3 p, double t) { return p.x - 0.1 * t; });
    SpaceTimeSurfaces surfaces;
    const SurfaceMesh flat = surfaces.atTime(plain, 0, 0.05, {0, 1, 0.5}, {}, 0);
    const double slack = 1e-6;
    double least = 1, most = -1;
    for (const glm::vec3& p : flat.positions) {
        EXPECT_NEAR(p.x, 0.1, 1e-5);
        least = std::min(least, double(p.y));
        most = std::max(most, double(p.y));
    }
    EXPECT_NEAR(least, -1, slack);
    EXPECT_NEAR(most, 1, slack);
    const Lattice uneven = test::layeredLattice(AxisMap::Of::Points);
    const glm::dvec3 lo = uneven.position(glm::ivec3(0)), hi = uneven.position(uneven.size - 1),
                     middle = 0.5 * (lo + hi);
    const auto layers = dataOf(uneven, {0, 1}, [&](glm::dvec3 p, double) { return p.z; });
    const SurfaceMesh inSpace = surfaces.atTime(layers, 0, middle.z, {0, 1, 0.5}, {}, 0);
    const SurfaceMesh onSheet = surfaces.atTime(layers, 0, middle.z, {0, 1, 0.5}, uneven.axes, 0);
    ASSERT_FALSE(inSpace.positions.empty());
    ASSERT_EQ(inSpace.positions.size(), onSheet.positions.size());
    for (std::size_t i = 0; i < inSpace.positions.size(); ++i) {
        const glm::dvec3 place = inSpace.origin + glm::dvec3(inSpace.positions[i]);
        EXPECT_NEAR(place.z, middle.z, 1e-5 * (hi.z - lo.z));
        EXPECT_LT(
            glm::length((onSheet.origin + glm::dvec3(onSheet.positions[i]) - uneven.axes.toSheet(place)) / (hi - lo)),
            1e-5);
    }
}

// A ball that moves along z at a speed of 0.5: in a plane that moves with it a column that stands still.
TEST(SpaceTimeSurfaces, InAPlaneHaveItsPlacesAndPointToLowerValues) {
    const auto moving = [](glm::dvec3 p, double t) { return 0.4 - glm::length(p - glm::dvec3(0, 0, 0.5 * t)); };
    const auto data = dataOf(cubeAround(33), timesAcross(17), moving);
    SpaceTimeSurfaces surfaces;
    for (const SpaceAxis axis : {SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z})
        for (const double degrees : {20.0, -30.0, 60.0, -70.0, 90.0}) {
            const SpaceTimePlane plane = planeOf(data->info(), {.axis = axis, .degrees = degrees});
            const SurfaceMesh mesh = surfaces.inPlane(data, 0, 0, plane, {}, 0);
            ASSERT_GT(mesh.positions.size(), 100u);
            int outwards = 0;
            for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                const glm::dvec3 place = mesh.origin + glm::dvec3(mesh.positions[i]);
                const glm::dvec4 point = plane.pointAt(place);
                EXPECT_NEAR(moving(glm::dvec3(point), point.w), 0, 0.03);
                const glm::dvec4 beyond = plane.pointAt(place + 0.02 * glm::dvec3(mesh.normals[i]));
                outwards += moving(glm::dvec3(beyond), beyond.w) < moving(glm::dvec3(point), point.w);
            }
            EXPECT_GT(outwards, 0.98 * double(mesh.positions.size())) << int(axis) << " " << degrees;
        }
}

TEST(SpaceTimeSurfaces, KeepMeshesOfTheDataThatThereAre) {
    auto data = dataOf(cubeAround(9), {-1, 0, 1}, hypersphere);
    SpaceTimeSurfaces one(1); // no room: the last one alone
    const TimePair early{0, 1, 0.5}, late{1, 2, 0.5};
    EXPECT_FALSE(one.atTime(data, 0, 0, early, {}, 0).triangles.empty());
    EXPECT_FALSE(one.atTime(data, 0, 0, late, {}, 0).triangles.empty());
    EXPECT_TRUE(one.keeps(data, 0, 0, late, 0));
    EXPECT_TRUE(one.keeps(data, 0, 0, {2, 2, 0}, 0)) << "at the last time it is the end of the last interval";
    EXPECT_FALSE(one.keeps(data, 0, 0, early, 0));
    EXPECT_FALSE(one.keeps(data, 0, 0, late, 1));
    const auto other = dataOf(cubeAround(9), {-1, 0, 1}, hypersphere);
    EXPECT_FALSE(one.keeps(other, 0, 0, late, 0));
    EXPECT_TRUE(SpaceTimeSurfaces().atTime(dataOf(cubeAround(9), {0}, hypersphere), 0, 0, {}, {}, 0).triangles.empty());
}

TEST(SpaceTimeSurfaces, OfMuchDataAreOfACoarserLevel) {
    const auto data = dataOf(cubeAround(33), timesAcross(3), hypersphere);
    EXPECT_EQ(levelOfSpaceTime(data->grid(), 3), 0);
    EXPECT_GT(levelOfSpaceTime(data->grid(), 10000), 0);
}

/// How often each edge is used.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edgesOf(const SurfaceMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) ++edges[std::minmax(t[i], t[(i + 1) % 3])];
    return edges;
}

TEST(FinerMesh, StaysClosedAndWhereItWas) {
    const auto data = dataOf(cubeAround(12), {0}, [](glm::dvec3 p, double) { return 0.8 - glm::length(p); });
    SurfaceMesh mesh = extractIsosurface(*data, 0, 0, 0, 0);
    for (const glm::vec3& p : mesh.positions) mesh.scalars.push_back(p.x);
    const glm::dvec3 scale(1, 2, 1);
    const FinerMesh fine = finerMesh(mesh, scale, 0.06);
    EXPECT_GT(fine.mesh.positions.size(), 4 * mesh.positions.size());
    ASSERT_EQ(fine.parents.size(), fine.mesh.positions.size());
    for (const auto& [edge, count] : edgesOf(fine.mesh)) {
        EXPECT_EQ(count, 2);
        const glm::dvec3 along = glm::dvec3(fine.mesh.positions[edge.second] - fine.mesh.positions[edge.first]) * scale;
        EXPECT_LE(glm::length(along), 0.06 + 1e-6);
    }
    EXPECT_NEAR(volumeWithin(fine.mesh), volumeWithin(mesh), 1e-6);
    EXPECT_NEAR(areaOf(fine.mesh, scale), areaOf(mesh, scale), 1e-5);
    EXPECT_NEAR(areaOf(mesh, glm::dvec3(1)), 4 * std::numbers::pi * 0.64, 0.03 * 4 * std::numbers::pi * 0.64);
    for (std::size_t i = 0; i < fine.parents.size(); ++i) {
        EXPECT_NEAR(fine.mesh.scalars[i], fine.mesh.positions[i].x, 1e-5);
        const glm::uvec3 parent = mesh.triangles[fine.parents[i]];
        const glm::dvec3 a = mesh.positions[parent.x], b = mesh.positions[parent.y], c = mesh.positions[parent.z];
        const glm::dvec3 p = fine.mesh.positions[i];
        const double whole = glm::length(glm::cross(b - a, c - a));
        const double parts = glm::length(glm::cross(a - p, b - p)) + glm::length(glm::cross(b - p, c - p)) +
                             glm::length(glm::cross(c - p, a - p));
        EXPECT_NEAR(parts, whole, 1e-5) << "in its triangle";
    }
    EXPECT_EQ(finerMesh(mesh, scale, 10).mesh, mesh);
}

} // namespace
} // namespace tessera::volume
