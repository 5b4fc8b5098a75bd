#include "vis/shapes/rotation_n.h"

#include "vis/optics/ray_setup.h"
#include "vis/scene/selection.h"
#include "vis/shapes/cloud4.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

namespace tessera::vis {
namespace {

double difference(const RotationN& a, const RotationN& b) {
    double most = 0;
    for (int c = 0; c < kMostAxes; ++c)
        for (int r = 0; r < kMostAxes; ++r) most = std::max(most, std::abs(a.at(r, c) - b.at(r, c)));
    return most;
}

RotationN randomRotation(std::mt19937& random, int axes) {
    std::uniform_real_distribution<double> uniform(-180, 180);
    std::vector<double> angles(std::size_t(planeCount(axes)));
    for (double& angle : angles) angle = uniform(random);
    return rotationOf(angles);
}

/// The rotation of sessions with four axes, written out: zw * yw * xw * yz * xz * xy, in degrees.
glm::dmat4 rotationOfFour(const std::array<double, 6>& degrees) {
    constexpr int kAxes[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
    glm::dmat4 out(1);
    for (std::size_t plane = 0; plane < 6; ++plane) {
        const auto [a, b] = kAxes[plane];
        const double angle = glm::radians(degrees[plane]);
        glm::dmat4 turned(1);
        turned[a][a] = turned[b][b] = std::cos(angle);
        turned[a][b] = std::sin(angle);
        turned[b][a] = -std::sin(angle);
        out = turned * out;
    }
    return out;
}

TEST(RotationN, PlanesTurnTheirFirstAxisTowardsTheSecond) {
    for (int plane = 0; plane < planeCount(kMostAxes); ++plane) {
        const auto [a, b] = planeAxes(plane);
        ASSERT_LT(a, b);
        EXPECT_EQ(planeIndex(a, b), plane);
        const RotationN quarter = planeRotation(a, b, 1.5707963267948966);
        for (int axis = 0; axis < kMostAxes; ++axis) {
            PointN at{}, wanted{};
            at[std::size_t(axis)] = 1;
            wanted[std::size_t(axis == a ? b : axis == b ? a : axis)] = axis == b ? -1 : 1;
            const PointN got = quarter * at;
            for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 1e-12) << plane << axis;
        }
    }
    EXPECT_EQ(planeAxes(0), std::pair(0, 1));
    EXPECT_EQ(planeAxes(5), std::pair(2, 3));
    EXPECT_EQ(planeAxes(27), std::pair(6, 7));
}

TEST(RotationN, IsOrthonormalWithAnyNumberOfAxes) {
    std::mt19937 random(1);
    for (int axes = 2; axes <= kMostAxes; ++axes)
        for (int trial = 0; trial < 30; ++trial) {
            const RotationN r = randomRotation(random, axes);
            EXPECT_LT(difference(r * r.inverse(), RotationN()), 1e-12);
            for (int unused = axes; unused < kMostAxes; ++unused) EXPECT_EQ(r.at(unused, unused), 1);
        }
}

TEST(RotationN, IsThatOfSessionsWithFourAxes) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-180, 180);
    for (int trial = 0; trial < 200; ++trial) {
        std::array<double, 6> angles{};
        for (double& angle : angles) angle = uniform(random);
        const RotationN r = rotationOf({angles.begin(), angles.end()});
        const glm::dmat4 four = rotationOfFour(angles), got = r.firstAxes();
        EXPECT_NEAR(glm::determinant(got), 1, 1e-12);
        for (int c = 0; c < 4; ++c)
            for (int row = 0; row < 4; ++row) ASSERT_NEAR(got[c][row], four[c][row], 1e-12);
        EXPECT_EQ(r.furtherAxes(), glm::dmat4(0));
    }
    // Small angles come back as they are in saved sessions.
    const std::vector<double> small{50, -30, 20, 40, -25, 130}, back = anglesOf(rotationOf(small), 4);
    ASSERT_EQ(back.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back[i], small[i], 1e-9);
}

TEST(RotationN, AnglesGiveTheRotationBack) {
    std::mt19937 random(2);
    for (int axes = 2; axes <= kMostAxes; ++axes)
        for (int trial = 0; trial < 60; ++trial) {
            const RotationN r = randomRotation(random, axes);
            const std::vector<double> angles = anglesOf(r, axes);
            ASSERT_EQ(angles.size(), std::size_t(planeCount(axes)));
            EXPECT_LT(difference(rotationOf(angles), r), 1e-9);
            for (const double angle : angles) EXPECT_LE(std::abs(angle), 180.0 + 1e-9);
        }
    // Where axes coincide many sets of angles are right; any will do.
    const std::vector<std::vector<double>> coinciding{
        {0, 0, 0, 90, 0, 0}, {10, 90, 20, 0, 90, 30}, {0, 0, 0, 0, 0, 180}, {5, -90, 0, -90, 90, 90}};
    for (const std::vector<double>& start : coinciding)
        EXPECT_LT(difference(rotationOf(anglesOf(rotationOf(start), 4)), rotationOf(start)), 1e-9);
}

TEST(RotationN, ManySmallTurnsStayARotation) {
    RotationN r;
    for (int i = 0; i < 3000; ++i) {
        const auto [a, b] = planeAxes(i % 15);
        r = rotationOf(anglesOf(planeRotation(a, b, 0.01 + 0.001 * (i % 7)) * r, 6));
    }
    EXPECT_LT(difference(r * r.inverse(), RotationN()), 1e-9);
}

TEST(RotationN, TheNearestFacedTurnHasTwoAxesAlongThePicture) {
    std::mt19937 random(5);
    EXPECT_FALSE(facedAxes(randomRotation(random, 4)));
    for (int axes = 4; axes <= kMostAxes; axes += 2)
        for (int trial = 0; trial < 30; ++trial) {
            const RotationN r = randomRotation(random, axes), faced = nearestFaced(r, axes);
            EXPECT_LT(difference(faced * faced.inverse(), RotationN()), 1e-12);
            // A rotation and not a reflection: angles exist, and give it back.
            EXPECT_LT(difference(rotationOf(anglesOf(faced, axes)), faced), 1e-9);
            const auto two = facedAxes(faced);
            ASSERT_TRUE(two);
            for (int right = 0; right < axes; ++right)
                for (int up = 0; up < axes; ++up)
                    if (up != right) {
                        EXPECT_GE(r.at(0, (*two)[0]) + r.at(1, (*two)[1]), r.at(0, right) + r.at(1, up));
                    }
        }
    EXPECT_EQ(nearestFaced(RotationN(), 4), RotationN());
    // Of some axes alone.
    EXPECT_EQ(facedAxes(nearestFaced(RotationN(), 4, {0, 2, 3})), (std::array{0, 2}));
    EXPECT_EQ(facedAxes(nearestFaced(planeRotation(0, 2, 1.4), 4, {1, 3})), (std::array{3, 1}));
}

TEST(Tesseract, HasSixteenCornersAndThirtyTwoEdges) {
    for (int axes = 3; axes <= kMostAxes; ++axes) {
        PointN half{};
        half.fill(0.5);
        std::set<std::pair<int, int>> seen;
        std::map<int, int> degree, along;
        for (const EdgeN& edge : edgesOf(axes)) {
            EXPECT_TRUE(seen.insert({edge.from, edge.to}).second);
            const PointN from = cornerOf(edge.from, half, axes), to = cornerOf(edge.to, half, axes);
            for (int axis = 0; axis < kMostAxes; ++axis)
                EXPECT_EQ(to[std::size_t(axis)] - from[std::size_t(axis)], axis == edge.axis ? 1 : 0);
            ++degree[edge.from];
            ++degree[edge.to];
            ++along[edge.axis];
        }
        EXPECT_EQ(seen.size(), std::size_t(axes) << (axes - 1));
        for (int axis = 0; axis < axes; ++axis) EXPECT_EQ(along[axis], 1 << (axes - 1));
        for (int corner = 0; corner < 1 << axes; ++corner) EXPECT_EQ(degree[corner], axes);
    }
}

TEST(Projection4, KnownCornersOfTheTesseract) {
    // Seen from eye 2 along w: the near cell is (2 / (2 - 1/2)) / (2 / (2 + 1/2)) = 5/3 times the far one.
    const Projection4 projection{.eye = 2, .eye3 = 1000};
    const auto near = project(projection, 1, {0.1, 0.2, 0, 0.5}), far = project(projection, 1, {0.1, 0.2, 0, -0.5});
    EXPECT_NEAR(near.at.x / far.at.x, 5.0 / 3, 1e-3);
    EXPECT_NEAR(near.at.y / far.at.y, 5.0 / 3, 1e-3);
    EXPECT_NEAR(near.at.y / near.at.x, 2, 1e-12);
    EXPECT_NEAR(near.scale / far.scale, 5.0 / 3, 1e-3);
    EXPECT_EQ(near.depthW, 0.25);
    EXPECT_EQ(far.depthW, 0.75);
    EXPECT_LT(project(projection, 1, {0, 0, 0.5, 0}).depth, project(projection, 1, {0, 0, -0.5, 0}).depth);
}

TEST(Projection4, ParallelProjectionLeavesDepthOut) {
    const Projection4 projection{.zoom = 1.5, .parallel = true};
    for (const glm::dvec2 behind : {glm::dvec2(0.3, 0.4), glm::dvec2(-0.5, 0.1)}) {
        const Projected4 at = project(projection, 1, {0.1, -0.2, behind.x, behind.y});
        EXPECT_NEAR(at.at.x, 0.15, 1e-15);
        EXPECT_NEAR(at.at.y, -0.3, 1e-15);
        EXPECT_EQ(at.scale, 1.5);
    }
}

// What both eyes see apart: E (away / d - away / (away - z)) in the picture's scale, E the distance between the eyes,
// d that of convergence.
TEST(Projection4, EyesSeeApartAsTheFormulaSays) {
    constexpr double kBetween = 0.08;
    for (const double convergence : {0.8, 1.0, 1.3})
        for (const bool parallel : {false, true}) {
            Projection4 left{
                .eye = 1.8, .eye3 = 3, .parallel = parallel, .aside = -kBetween / 2, .convergence = convergence};
            Projection4 right = left, middle = left;
            right.aside = kBetween / 2;
            middle.aside = 0;
            const double radius = parallel ? 1 : 1.8 / std::sqrt(1.8 * 1.8 - 1), away = 3 * radius;
            const double fit = parallel ? 1 : std::sqrt(8.0) / away;
            for (const double z : {-0.6, 0.0, 0.5}) {
                const glm::dvec4 at(0.2, 0.3, z, 0);
                const Projected4 a = project(left, 1, at), b = project(right, 1, at), m = project(middle, 1, at);
                const double seen = parallel ? 1 + z / away : away / (away - z);
                EXPECT_NEAR(b.at.x - a.at.x, kBetween * away * (1 / convergence - seen) * fit, 1e-12);
                EXPECT_NEAR((a.at.x + b.at.x) / 2, m.at.x, 1e-12);
                EXPECT_EQ(a.at.y, m.at.y) << "nothing is displaced upwards";
            }
        }
    // Nearer than the screen: the right eye sees it further left.
    const Projection4 right{.aside = 0.04};
    EXPECT_LT(project(right, 1, {0, 0, 0.5, 0}).at.x, 0);
    EXPECT_GT(project(right, 1, {0, 0, -0.5, 0}).at.x, 0);
}

TEST(Projection4, NothingBlowsUpAtAnyAngle) {
    std::mt19937 random(3);
    for (const double eye : {0.0, 1.0, 1.05, 1.1, 1.8, 20.0})
        for (const double eye3 : {0.5, 1.2, 3.0}) {
            double most = 0;
            for (int trial = 0; trial < 400; ++trial) {
                const RotationN r = randomRotation(random, 4);
                for (int corner = 0; corner < 16; ++corner) {
                    const Projected4 at = project({.eye = eye, .eye3 = eye3}, 1,
                                                  firstFour(r * cornerOf(corner, {0.5, 0.5, 0.5, 0.5}, 4)));
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
    CloudStyle flat = someStyle(); // the other grid of BCC lies half a cell off
    flat.bounds.hi.z = 0;
    for (const CloudPoint& point : makeCloud(someSamples(), flat)) EXPECT_EQ(point.position.z, 0);
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
    const RotationN turned = planeRotation(0, 3, 0.4) * planeRotation(1, 2, -0.2);
    for (const RotationN& rotation : {RotationN(), turned})
        for (std::size_t i = 1; i < points.size(); ++i) {
            const glm::dvec2 at =
                project(projection, 1, firstFour(rotation * pointOf(glm::dvec4(points[i].position)))).at;
            EXPECT_EQ(nearestPoint(points, rotation, projection, at + glm::dvec2(0.002, -0.001), 0.02), i);
        }
    EXPECT_FALSE(nearestPoint(points, RotationN(), projection, {0.9, 0.9}, 0.02));
    // Nearly in line with the eye: the one in front.
    const glm::dvec2 between = 0.5 * (project(projection, 1, glm::dvec4(points[0].position)).at +
                                      project(projection, 1, glm::dvec4(points[1].position)).at);
    EXPECT_EQ(nearestPoint(points, RotationN(), projection, between, 2), 1u);
}

TEST(Cloud4, FurtherAxesPlaceSamplesAndLeaveOutThoseWithoutAValue) {
    CloudStyle style = someStyle();
    style.half = {0.4, 0.4, 0.4, 0.4, 0.3};
    style.further = {{.channel = 1, .range = {0, 4}}};
    volume::Samples4 samples = someSamples();
    samples.values[3] = NAN; // of the second one, along the fifth axis
    const auto points = makeCloud(samples, style);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].sample, 0u);
    EXPECT_EQ(points[1].sample, 2u);
    EXPECT_NEAR(points[0].further.x, 0.3 * (2 * 1.0 / 4 - 1), 1e-6);
    EXPECT_NEAR(points[1].further.x, 0.3 * (2 * 3.0 / 4 - 1), 1e-6);
}

TEST(Cloud4, NormalsAreThoseOfTheBoxAndShadeByTheirCosine) {
    volume::Samples4 samples = someSamples();
    samples.gradients = {{1, 0, 0, 0}, {0, 0, 0, 2}, {0.1f, 0.05f, 0, 0}, {1, 1, 1, 1}};
    const auto points = makeCloud(samples, someStyle()); // edges 10, 20, 30 and 4 in a cube
    ASSERT_EQ(points.size(), 3u);
    EXPECT_EQ(points[0].normal, glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(points[1].normal, glm::vec4(0, 0, 0, 1));
    const glm::vec4 slanted = glm::normalize(glm::vec4(0.1f * 10, 0.05f * 20, 0, 0));
    EXPECT_LT(glm::length(points[2].normal - slanted), 1e-6f);
    // With a parameter along the fourth axis the samples are a surface w = f(x, y, z), whose normal is (grad f, -1).
    CloudStyle value = someStyle();
    value.fourthChannel = 1;
    value.fourth = {1, 3};
    const glm::vec4 surface = makeCloud(samples, value)[0].normal;
    EXPECT_LT(glm::length(surface - glm::normalize(glm::vec4(1 * 10, 0, 0, -1 * 2))), 1e-6f);
    const Light4 light{.towards = {0, 0, 0, 1}, .ambient = 0.2};
    EXPECT_NEAR(litBy(light, {0.6, 0, 0, 0.8}), 0.2 + 0.8 * 0.8, 1e-12);
    EXPECT_NEAR(litBy(light, {0.6, 0, 0, -0.8}), 0.2 + 0.8 * 0.8, 1e-12) << "from both sides";
    EXPECT_EQ(litBy(light, glm::dvec4(0)), 1) << "no normal";
    EXPECT_EQ(litBy({}, {1, 0, 0, 0}), 1) << "no light";
}

} // namespace
} // namespace tessera::vis
