#include "vis/shapes/rotation4.h"

#include "vis/optics/ray_setup.h"
#include "vis/shapes/cloud4.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

namespace tessera::vis {
namespace {

double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) most = std::max(most, std::abs(a[c][r] - b[c][r]));
    return most;
}

glm::dmat4 randomRotation(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-180, 180);
    Angles4 angles{};
    for (double& angle : angles) angle = uniform(random);
    return rotationOf(angles);
}

TEST(Rotation4, PlanesTurnTheirFirstAxisTowardsTheSecond) {
    constexpr int kAxes[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
    for (int plane = 0; plane < 6; ++plane) {
        const glm::dmat4 quarter = planeRotation(Plane4(plane), 1.5707963267948966);
        for (int axis = 0; axis < 4; ++axis) {
            glm::dvec4 at(0), wanted(0);
            at[axis] = 1;
            if (axis == kAxes[plane][0])
                wanted[kAxes[plane][1]] = 1;
            else if (axis == kAxes[plane][1])
                wanted[kAxes[plane][0]] = -1;
            else
                wanted[axis] = 1;
            EXPECT_LT(glm::length(quarter * at - wanted), 1e-12) << kPlane4Names[std::size_t(plane)] << axis;
        }
    }
}

TEST(Rotation4, IsOrthogonalAndComposesInTheOrderSaid) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const glm::dmat4 r = randomRotation(random);
        EXPECT_LT(difference(r * glm::transpose(r), glm::dmat4(1)), 1e-12);
        EXPECT_NEAR(glm::determinant(r), 1, 1e-12);
    }
    const glm::dmat4 both = rotationOf({30, 0, 0, 0, 0, 70});
    EXPECT_LT(
        difference(both, planeRotation(Plane4::ZW, glm::radians(70.0)) * planeRotation(Plane4::XY, glm::radians(30.0))),
        1e-12);
    const glm::dmat4 order = rotationOf({20, 40, 0, 0, 0, 0});
    EXPECT_LT(difference(order,
                         planeRotation(Plane4::XZ, glm::radians(40.0)) * planeRotation(Plane4::XY, glm::radians(20.0))),
              1e-12);
}

TEST(Rotation4, AnglesGiveTheRotationBack) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 500; ++trial) {
        const glm::dmat4 r = randomRotation(random);
        const Angles4 angles = anglesOf(r);
        EXPECT_LT(difference(rotationOf(angles), r), 1e-9);
        for (const double angle : angles) EXPECT_LE(std::abs(angle), 180.0 + 1e-9);
    }
    // Where axes coincide many sets of angles are right; any will do.
    for (const Angles4& start : {Angles4{0, 0, 0, 90, 0, 0}, Angles4{10, 90, 20, 0, 90, 30},
                                 Angles4{0, 0, 0, 0, 0, 180}, Angles4{5, -90, 0, -90, 90, 90}})
        EXPECT_LT(difference(rotationOf(anglesOf(rotationOf(start))), rotationOf(start)), 1e-9);
    // In the middle the angles themselves come back.
    const Angles4 small{50, -30, 20, 40, -25, 130}, back = anglesOf(rotationOf(small));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back[i], small[i], 1e-9);
}

TEST(Rotation4, ManySmallTurnsStayARotation) {
    glm::dmat4 r(1);
    for (int i = 0; i < 20000; ++i) r = rotationOf(anglesOf(planeRotation(Plane4(i % 6), 0.01 + 0.001 * (i % 7)) * r));
    EXPECT_LT(difference(r * glm::transpose(r), glm::dmat4(1)), 1e-9);
}

TEST(Tesseract, HasSixteenCornersAndThirtyTwoEdges) {
    const glm::dvec4 half(0.5);
    std::set<std::pair<int, int>> seen;
    std::map<int, int> degree;
    int along[4] = {};
    for (const Edge4& edge : edges4()) {
        EXPECT_TRUE(seen.insert({edge.from, edge.to}).second);
        const glm::dvec4 way = corner4(edge.to, half) - corner4(edge.from, half);
        EXPECT_NEAR(glm::length(way), 1, 1e-15);
        EXPECT_EQ(way[edge.axis], 1);
        ++degree[edge.from];
        ++degree[edge.to];
        ++along[edge.axis];
    }
    for (int axis = 0; axis < 4; ++axis) EXPECT_EQ(along[axis], 8);
    for (int corner = 0; corner < kCorners4; ++corner) EXPECT_EQ(degree[corner], 4);
}

TEST(Projection4, KnownCornersOfTheTesseract) {
    // Seen from eye 2 along w: the near cell is (2 / (2 - 1/2)) / (2 / (2 + 1/2)) = 5/3 times the far one.
    const Projection4 projection{2, 1000, 1};
    const auto near = project(projection, 1, {0.1, 0.2, 0, 0.5}), far = project(projection, 1, {0.1, 0.2, 0, -0.5});
    EXPECT_NEAR(near.at.x / far.at.x, 5.0 / 3, 1e-3);
    EXPECT_NEAR(near.at.y / far.at.y, 5.0 / 3, 1e-3);
    EXPECT_NEAR(near.at.y / near.at.x, 2, 1e-12);
    EXPECT_NEAR(near.scale / far.scale, 5.0 / 3, 1e-3);
    EXPECT_EQ(near.depthW, 0.25);
    EXPECT_EQ(far.depthW, 0.75);
    EXPECT_LT(project(projection, 1, {0, 0, 0.5, 0}).depth, project(projection, 1, {0, 0, -0.5, 0}).depth);
}

TEST(Projection4, NothingBlowsUpAtAnyAngle) {
    std::mt19937 random(3);
    const glm::dvec4 half = glm::dvec4(0.5); // of radius 1
    for (const double eye : {0.0, 1.0, 1.05, 1.1, 1.8, 20.0})
        for (const double eye3 : {0.5, 1.2, 3.0}) {
            double most = 0;
            for (int trial = 0; trial < 400; ++trial) {
                const glm::dmat4 r = randomRotation(random);
                for (int corner = 0; corner < kCorners4; ++corner) {
                    const Projected4 at = project({eye, eye3, 1}, 1, r * corner4(corner, half));
                    ASSERT_TRUE(std::isfinite(at.at.x) && std::isfinite(at.at.y) && at.scale > 0);
                    ASSERT_LE(glm::length(at.at), 1 + 1e-9);
                    ASSERT_GE(at.depth, -1e-9);
                    ASSERT_LE(at.depth, 1 + 1e-9);
                    most = std::max(most, glm::length(at.at));
                }
            }
            EXPECT_GT(most, 0.5); // and uses the room
        }
}

volume::Samples4 someSamples() {
    volume::Samples4 samples;
    samples.channels = 2;
    samples.positions = {{0, 0, 0}, {10, 20, 30}, {5, 10, 15}, {5, 10, 15}};
    samples.times = {0, 4, 2, 2};
    samples.values = {0, 1, 1, 2, 0.5f, 3, NAN, 4};
    return samples;
}

CloudStyle someStyle() {
    CloudStyle style;
    style.bounds = {{0, 0, 0}, {10, 20, 30}};
    style.fourth = {0, 4};
    style.transfer.opacity = {{0, 0.5f}, {1, 0.5f}};
    style.density = 4.0 / 60000; // four samples look as the transfer function says
    return style;
}

TEST(Cloud4, PlacesSamplesInTheTesseract) {
    const auto points = makeCloud(someSamples(), someStyle());
    ASSERT_EQ(points.size(), 3u); // the absent one is left out
    EXPECT_EQ(points[0].position, glm::vec4(-0.5f));
    EXPECT_EQ(points[1].position, glm::vec4(0.5f));
    EXPECT_EQ(points[2].position, glm::vec4(0));
    for (const CloudPoint& point : points) EXPECT_NEAR(point.color.a, 0.5, 1e-5);
    CloudStyle value = someStyle();
    value.fourthChannel = 1;
    value.fourth = {1, 3};
    const auto byValue = makeCloud(someSamples(), value);
    EXPECT_EQ(byValue[0].position.w, -0.5f);
    EXPECT_EQ(byValue[1].position.w, 0);
    EXPECT_EQ(byValue[2].position.w, 0.5f);
}

TEST(Cloud4, BrushesFadeWhatTheyLeaveOut) {
    CloudStyle style = someStyle();
    style.selection.brushes = {rangeBrush({{"b", 1.5, 2.5, 0}})};
    style.selection.contextOpacity = 0.2f;
    style.selection.contextSaturation = 0;
    style.doiChannels = {1};
    const auto points = makeCloud(someSamples(), style);
    ASSERT_EQ(points.size(), 3u);
    EXPECT_NEAR(points[0].color.a, 0.1, 1e-5);
    EXPECT_NEAR(points[1].color.a, 0.5, 1e-5);
    EXPECT_NEAR(points[2].color.r, points[2].color.g, 1e-6); // grey
    EXPECT_GT(std::abs(points[1].color.r - points[1].color.b), 0.1);
    style.selection.contextOpacity = 0;
    EXPECT_EQ(makeCloud(someSamples(), style).size(), 1u); // focus points only
}

TEST(Cloud4, ThePointUnderAPlaceIsTheNearerOfThoseThere) {
    std::vector<CloudPoint> points(4);
    points[0].position = {0.3f, 0.2f, -0.4f, 0}; // behind the next one
    points[1].position = {0.3f, 0.2f, 0.4f, 0};
    points[2].position = {-0.5f, 0.1f, 0, 0.2f};
    points[3].position = {0, -0.6f, 0, -0.3f};
    const Projection4 projection;
    const glm::dmat4 turned = planeRotation(Plane4::XW, 0.4) * planeRotation(Plane4::YZ, -0.2);
    for (const glm::dmat4& rotation : {glm::dmat4(1), turned})
        for (std::size_t i = 1; i < points.size(); ++i) {
            const glm::dvec2 at = project(projection, 1, rotation * glm::dvec4(points[i].position)).at;
            EXPECT_EQ(nearestPoint(points, rotation, projection, at + glm::dvec2(0.002, -0.001), 0.02), i);
        }
    EXPECT_FALSE(nearestPoint(points, glm::dmat4(1), projection, {0.9, 0.9}, 0.02));
    // Nearly in line with the eye: the one in front.
    const glm::dvec2 between = 0.5 * (project(projection, 1, glm::dvec4(points[0].position)).at +
                                      project(projection, 1, glm::dvec4(points[1].position)).at);
    EXPECT_EQ(nearestPoint(points, glm::dmat4(1), projection, between, 2), 1u);
}

} // namespace
} // namespace tessera::vis
