#include "app/pane/oblique_plane.h"
#include "app/planes/plane_export.h"
#include "tests/app/formula_cell.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>
#include <sstream>

/// Tilted planes as geometry.
namespace tessera::app {
namespace {

struct PlaneRandom {
    std::mt19937 engine{11};
    double operator()(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }
    glm::dvec3 direction() { return unitNormal({(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}); }
    glm::dvec3 in(const volume::Box& box) {
        return {(*this)(box.lo.x, box.hi.x), (*this)(box.lo.y, box.hi.y), (*this)(box.lo.z, box.hi.z)};
    }
};

const volume::Box kPlaneBox{{-1, 0.5, 2}, {3, 1.5, 5}};

bool inPlaneBox(glm::dvec3 place, double slack = 1e-9) {
    for (int axis = 0; axis < 3; ++axis)
        if (place[axis] < kPlaneBox.lo[axis] - slack || place[axis] > kPlaneBox.hi[axis] + slack) return false;
    return true;
}

TEST(ObliquePlane, TheSectionIsAConvexPolygonOfThePlaneInTheBox) {
    const volume::Box cube{glm::dvec3(0), glm::dvec3(1)};
    EXPECT_EQ(planeSection({unitNormal({1, 1, 1}), glm::dvec3(0.5)}, cube).size(), 6u);
    EXPECT_EQ(planeSection({{0, 0, 1}, glm::dvec3(0.5)}, cube).size(), 4u);
    EXPECT_EQ(planeSection({{0, 0, 1}, {0, 0, 1}}, cube).size(), 4u) << "a face";
    EXPECT_EQ(planeSection({unitNormal({1, 1, 0}), glm::dvec3(0.5)}, cube).size(), 4u) << "through edges";
    EXPECT_TRUE(planeSection({{0, 0, 1}, {0, 0, 1.01}}, cube).empty());
    PlaneRandom random;
    for (int i = 0; i < 300; ++i) {
        const SpacePlane plane{random.direction(), random.in(kPlaneBox)};
        const std::vector<glm::dvec3> corners = planeSection(plane, kPlaneBox);
        ASSERT_GE(corners.size(), 3u);
        ASSERT_LE(corners.size(), 6u);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            EXPECT_NEAR(plane.distance(corners[k]), 0, 1e-9);
            EXPECT_TRUE(inPlaneBox(corners[k]));
            const glm::dvec3 a = corners[(k + 1) % corners.size()] - corners[k],
                             b = corners[(k + 2) % corners.size()] - corners[(k + 1) % corners.size()];
            EXPECT_GE(glm::dot(glm::cross(a, b), plane.normal), -1e-9) << "around the normal";
        }
    }
}

TEST(ObliquePlane, TheNearestPlaceIsNearerThanAnyOther) {
    PlaneRandom random;
    for (int i = 0; i < 60; ++i) {
        const SpacePlane plane{random.direction(), random.in(kPlaneBox)};
        const glm::dvec3 place = 3.0 * random.in(kPlaneBox)-2.0 * kPlaneBox.center();
        const glm::dvec3 nearest = nearestInPlane(plane, kPlaneBox, place);
        EXPECT_NEAR(plane.distance(nearest), 0, 1e-9);
        EXPECT_TRUE(inPlaneBox(nearest));
        for (int k = 0; k < 500; ++k) {
            const glm::dvec3 any = random.in(kPlaneBox), other = any - plane.normal * plane.distance(any);
            if (inPlaneBox(other, 0)) {
                EXPECT_GE(glm::length(other - place), glm::length(nearest - place) - 1e-9);
            }
        }
        const glm::dvec3 in = plane.at;
        EXPECT_LT(glm::length(nearestInPlane(plane, kPlaneBox, in) - in), 1e-12) << "what lies in it stays";
    }
    const glm::dvec3 face = nearestInPlane({{0, 0, 1}, {0, 0, 99}}, kPlaneBox, {0, 0, 99});
    EXPECT_EQ(face, glm::dvec3(0, 0.5, 5)) << "a plane beside the box comes back to its face";
    const glm::dvec3 slant = unitNormal({1, 1, 1}),
                     back = nearestInPlane({slant, {99, 99, 99}}, kPlaneBox, {99, 99, 99});
    EXPECT_FALSE(planeSection({slant, back}, kPlaneBox).empty()) << "or just inside a corner";
    EXPECT_LT(glm::length(back - kPlaneBox.hi), 0.05);
}

TEST(ObliquePlane, FlatAxesAreAtRightAnglesInBothSpaces) {
    PlaneRandom random;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 stretch =
            i % 3 == 0 ? glm::dvec3(1) : glm::dvec3(random(0.2, 5), random(0.2, 5), random(0.2, 5));
        const vis::WorldFrame world = vis::worldFrame(kPlaneBox, stretch);
        const glm::dvec3 normal = random.direction();
        const FlatAxes axes = flatAxes(3.0 * normal, world);
        EXPECT_NEAR(glm::length(axes.right), 1, 1e-12);
        EXPECT_NEAR(glm::dot(axes.right, axes.up), 0, 1e-12);
        EXPECT_LT(glm::length(glm::cross(axes.right, axes.up) - normal), 1e-9) << "seen from where it points to";
        EXPECT_NEAR(glm::dot(axes.right * world.scale, axes.up * world.scale), 0, 1e-12);
        EXPECT_NEAR(axes.scale.x, glm::length(axes.right * world.scale), 1e-12);
        EXPECT_NEAR(axes.scale.y, glm::length(axes.up * world.scale), 1e-12);
        EXPECT_LT(glm::length(physicalNormal(worldNormal(normal, world), world) - normal), 1e-9);
        const glm::dvec3 upright = worldNormal(normal, world);
        EXPECT_NEAR(glm::dot(upright, axes.right * world.scale), 0, 1e-12) << "normal to the plane as it is drawn";
        EXPECT_NEAR(glm::dot(upright, axes.up * world.scale), 0, 1e-12);
    }
}

TEST(ObliquePlane, PlanesAcrossAnAxisLieAsInTheSlicesView) {
    const vis::WorldFrame world = vis::worldFrame(kPlaneBox, glm::dvec3(1));
    const auto expectAxes = [&](glm::dvec3 normal, glm::dvec3 right, glm::dvec3 up) {
        const FlatAxes axes = flatAxes(normal, world);
        EXPECT_LT(glm::length(axes.right - right), 1e-12);
        EXPECT_LT(glm::length(axes.up - up), 1e-12);
    };
    expectAxes({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    expectAxes({-1, 0, 0}, {0, 0, 1}, {0, 1, 0});
    expectAxes({0, -1, 0}, {1, 0, 0}, {0, 0, 1});
    expectAxes({0, 0, 0}, {1, 0, 0}, {0, 1, 0}); // no direction: across z
}

TEST(ObliquePlane, TheFlatCameraSeesThePlaneInItsAxes) {
    PlaneRandom random;
    for (int i = 0; i < 40; ++i) {
        const vis::WorldFrame world = vis::worldFrame(kPlaneBox, {random(0.3, 3), random(0.3, 3), random(0.3, 3)});
        const FlatAxes axes = flatAxes(random.direction(), world);
        const glm::dvec3 middle = random.in(kPlaneBox);
        const double height = random(0.5, 3), u = random(-0.5, 0.5), v = random(-0.5, 0.5), aspect = 1.4;
        const vis::Camera camera = flatCamera(axes, middle, height, world);
        const glm::dvec3 place = world.toWorld(middle + axes.right * u + axes.up * v);
        const glm::dvec4 clip = vis::projectionMatrix(camera, aspect) * vis::viewMatrix(camera) * glm::dvec4(place, 1);
        EXPECT_NEAR(clip.y / clip.w, 2 * v / height, 1e-5);
        EXPECT_NEAR(clip.x / clip.w, 2 * u * axes.scale.x / (height * axes.scale.y * aspect), 1e-5);
    }
}

TEST(ObliquePlane, DirectionsInWords) {
    EXPECT_EQ(directionText({1, 0, 0}), "x");
    EXPECT_EQ(directionText({0, 0, -1}), "-z");
    EXPECT_EQ(directionText(unitNormal({-1, 0, 1})), "-0.71 x + 0.71 z");
    EXPECT_EQ(directionText(unitNormal({3, -4, 0})), "0.60 x - 0.80 y");
}

TEST(TiltedPlane, SpansThePartInTheBoxInTheDatasUnit) {
    volume::DatasetInfo info = volume::makeMemorySource(formula::makeCell(), {})->info();
    info.bounds = {glm::dvec3(0), {0.004, 0.001, 0.04}};
    info.lengthUnit = "m";
    Session session;
    session.cursor = {0.001, 0.0004, 0.02};
    const PlanePicture flat = tiltedPlane(session, info, {-1, 0, 1}, {});
    // u = (x + z) / sqrt 2 from the lower to the upper end of x, where z - x is 0.019.
    const double root = std::sqrt(2);
    EXPECT_NEAR(flat.x.lo, (0.0 + 0.019) / root, 2e-4);
    EXPECT_NEAR(flat.x.hi, (0.004 + 0.023) / root, 2e-4);
    EXPECT_NEAR(flat.y.hi - flat.y.lo, 0.001, 1e-4);
    EXPECT_EQ(flat.right.name, "u");
    EXPECT_EQ(flat.up.name, "y");
    EXPECT_EQ(flat.right.unit.name, "mm");
    EXPECT_EQ(axesText(flat), "u = 0.71 x + 0.71 z");
    EXPECT_EQ(flat.place.substr(0, 35), "across -0.71 x + 0.71 z at 13.44 mm"); // 19 / sqrt 2
    const glm::dvec2 at = flat.along(session.cursor);
    EXPECT_LT(glm::length(flat.placeAt(at) - session.cursor), 1e-9);
    Session moved = session;
    moved.cursor = flat.placeAt(at + glm::dvec2(0.0004, 0.0002));
    EXPECT_EQ(tiltedPlane(moved, info, {-1, 0, 1}, {}).plane.at, flat.plane.at) << "in one plane there is one picture";
    const PlanePicture across = tiltedPlane(session, info, {0, 0, 1}, {});
    EXPECT_EQ(across.right.name, "x");
    EXPECT_EQ(axesText(across), "");
}

/// U.x of the formula cell rises along x alone, by 1 over its extent: so do values between the samples.
TEST(TiltedPlane, ExportsInterpolatedValuesInThePlane) {
    const auto source = volume::makeMemorySource(formula::makeCell(), {});
    Session session;
    session.cursor = {0.0123, 0.0041, -0.0009};
    const glm::dvec3 normal = unitNormal({-0.8, 0.1, 0.6});
    const PlanePicture flat = tiltedPlane(session, source->info(), normal, {});
    std::istringstream lines(csvOf(planesTable(*source, {flat}, {*source->info().findChannel("U.x")})));
    std::string line;
    std::getline(lines, line);
    EXPECT_NE(line.find("interpolated"), std::string::npos);
    std::getline(lines, line);
    EXPECT_EQ(line, "# u = 0.60 x + 0.80 z, v = 0.08 x + y - 0.06 z");
    std::getline(lines, line);
    EXPECT_EQ(line, "u [mm],v [mm],x [mm],y [mm],z [mm],U.x [m/s]");
    int rows = 0;
    for (double u, v, x, y, z, value; std::getline(lines, line); ++rows) {
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &u, &v, &x, &y, &z, &value), 6) << line;
        x /= 1000, y /= 1000, z /= 1000;
        EXPECT_NEAR(glm::dot(glm::dvec3(x, y, z) - session.cursor, normal), 0, 1e-10);
        EXPECT_LT(glm::length(flat.placeAt(glm::dvec2(u, v) / 1000.0) - glm::dvec3(x, y, z)), 1e-9);
        EXPECT_NEAR(value, 0.1 + (x - formula::kOrigin[0]) / (7 * formula::kSpacing[0]), 1e-5);
    }
    EXPECT_GT(rows, 1000);
}

} // namespace
} // namespace tessera::app
