#include "vis/lic/surface_strokes.h"

#include "tests/vis/function_source.h"
#include "volume/mesh/isosurface.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::vis {
namespace {

constexpr int kSamples = 24;
constexpr double kMiddle = (kSamples - 1) / 2.0, kBall = 8;

/// A ball f = 0 in a box, in a vector U that turns about z; U is absent where y lies beyond `absent`.
std::shared_ptr<const volume::BrickSource> turningBall(double absent = 1e300) {
    volume::Dataset data;
    data.info.lattice.size = glm::ivec3(kSamples);
    data.info.bounds = {glm::dvec3(0), glm::dvec3(kSamples - 1)};
    data.info.times = {0};
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "U";
    data.info.parameters[0].components = 3;
    data.info.parameters[0].ranges = {{-12, 12}, {-12, 12}, {-1, 1}, {0, 17}};
    data.info.parameters[1].name = "f";
    data.info.parameters[1].ranges = {{-20, 8}};
    data.read = [lattice = data.info.lattice, absent](int parameter, int component, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        std::size_t index = 0;
        for (int k = 0; k < kSamples; ++k)
            for (int j = 0; j < kSamples; ++j)
                for (int i = 0; i < kSamples; ++i, ++index) {
                    const glm::dvec3 at = glm::dvec3(i, j, k) - kMiddle, turning(-at.y, at.x, 0);
                    float& value = field.as<float>()[index];
                    value = float(parameter == 1 ? kBall - glm::length(at) : turning[component]);
                    if (parameter == 0 && at.y > absent) value = std::numeric_limits<float>::quiet_NaN();
                }
        if (parameter == 0) {
            auto mask = std::make_shared<volume::Mask>(field.count());
            for (std::size_t i = 0; i < field.count(); ++i) (*mask)[i] = !std::isnan(field.as<float>()[i]);
            field.mask = mask;
        }
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

Geometry ballOf(const volume::BrickSource& source) {
    Geometry geometry;
    geometry.mesh = volume::extractIsosurface(source, source.info().findChannel("f").value(), 0, 0, 0);
    return geometry;
}

SurfaceField fieldOn(const volume::SurfaceMesh& mesh, const std::function<glm::dvec3(glm::dvec3)>& vector) {
    SurfaceField field{{}, mesh.triangles, {}};
    for (const glm::vec3& position : mesh.positions) {
        field.places.push_back(glm::dvec3(position) - kMiddle);
        field.vectors.push_back(vector(field.places.back()));
    }
    return field;
}

// On a ball in a rotation lines are circles of latitude, as long as they are asked for, at even distances.
TEST(SurfaceStrokes, LinesFollowTheVectorOverTheSurface) {
    const auto source = turningBall();
    const volume::SurfaceMesh mesh = ballOf(*source).mesh;
    // A part along the normal, which is left out.
    const SurfaceField field = fieldOn(mesh, [](glm::dvec3 p) { return glm::dvec3(-p.y, p.x, 0) + 0.3 * p; });
    const auto neighbours = neighboursOf(field.triangles);
    for (const glm::ivec3& each : neighbours) EXPECT_GE(std::min({each.x, each.y, each.z}), 0) << "closed";
    int looked = 0;
    for (std::uint32_t t = 0; t < field.triangles.size(); t += 97) {
        const glm::uvec3 v = field.triangles[t];
        const glm::dvec3 middle = (field.places[v.x] + field.places[v.y] + field.places[v.z]) / 3.0;
        if (std::hypot(middle.x, middle.y) < 3) continue;
        std::size_t start = 0;
        const auto line = lineOnSurface(field, neighbours, {t, middle}, 0.25, 6, start);
        ASSERT_EQ(line.size(), 2u * 24 + 1);
        EXPECT_EQ(start, 24u);
        EXPECT_EQ(line[start], middle);
        double length = 0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            EXPECT_NEAR(line[i].z, middle.z, 0.25);
            EXPECT_NEAR(glm::length(line[i]), kBall, 0.2);
            if (i > 0) length += glm::distance(line[i], line[i - 1]);
        }
        EXPECT_NEAR(length, 12, 0.1);
        // It turns as the vector does.
        EXPECT_GT(glm::dot(line[start + 1] - line[start], glm::dvec3(-middle.y, middle.x, 0)), 0);
        ++looked;
    }
    EXPECT_GT(looked, 10);
}

TEST(SurfaceStrokes, LinesEndWhereTheVectorOrTheSurfaceDoes) {
    // Two triangles, a square of 2; to the right.
    SurfaceField field{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
    field.vectors.assign(4, glm::dvec3(1, 0, 0));
    std::size_t start = 0;
    const auto lineOf = [&] {
        return lineOnSurface(field, neighboursOf(field.triangles), {0, {1, 0.5, 0}}, 0.125, 4, start);
    };
    auto line = lineOf();
    EXPECT_NEAR(line.front().x, 0.0625, 0.0626);
    EXPECT_GT(line.back().x, 1.87);
    EXPECT_NEAR(line.front().y, 0.5, 1e-9);
    field.vectors.assign(4, glm::dvec3(0, 0, 5)); // across
    EXPECT_EQ(lineOf().size(), 1u);
    field.vectors.assign(4, glm::dvec3(0));
    EXPECT_EQ(lineOf().size(), 1u);
    field.vectors.assign(4, glm::dvec3(1, 0, 0));
    field.vectors[3] = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    line = lineOf();
    EXPECT_GT(line.front().x, 0.5 - 0.126) << "not into the other triangle, which begins at x = y";
}

/// How alike lightness is at vertices that an edge joins along or across the vector.
struct Alike {
    double along = 0, across = 0;
};
Alike alikeOf(const Geometry& geometry) {
    double sums[2] = {0, 0}, squares[2] = {0, 0};
    for (const glm::uvec3& t : geometry.mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            const glm::dvec3 at = glm::dvec3(geometry.mesh.positions[a]) - kMiddle;
            const glm::dvec3 edge = glm::normalize(glm::dvec3(geometry.mesh.positions[b] - geometry.mesh.positions[a]));
            const double share = std::abs(glm::dot(edge, glm::normalize(glm::dvec3(-at.y, at.x, 0))));
            const int way = share > 0.95 ? 0 : share < 0.3 ? 1 : -1;
            if (way < 0) continue;
            const double own = double(geometry.strokes[a]);
            sums[way] += std::abs(own - double(geometry.strokes[b]));
            squares[way] += 1;
        }
    return {sums[0] / squares[0], sums[1] / squares[1]};
}

TEST(SurfaceStrokes, AreSmoothAlongTheVectorAndFineAcross) {
    const auto source = turningBall();
    Geometry geometry = ballOf(*source);
    const std::size_t coarse = geometry.mesh.positions.size();
    Strokes strokes{.vector = "U", .length = 0.2f, .width = 0.02f};
    addStrokes(geometry, *source, 0, strokes, glm::dvec3(1), 1'000'000);
    EXPECT_GT(geometry.mesh.positions.size(), 2 * coarse);
    ASSERT_EQ(geometry.strokes.size(), geometry.mesh.positions.size());
    EXPECT_TRUE(geometry.notes.empty());
    double mean = 0, square = 0;
    for (const float each : geometry.strokes) {
        ASSERT_LE(std::abs(each), 1);
        mean += double(each) / double(geometry.strokes.size());
        square += double(each) * double(each) / double(geometry.strokes.size());
    }
    EXPECT_NEAR(mean, 0, 0.02);
    EXPECT_NEAR(std::sqrt(square), kStrokeDeviation, 0.03);
    const Alike alike = alikeOf(geometry);
    EXPECT_LT(alike.along, 0.4 * alike.across);
    Geometry again = ballOf(*source);
    addStrokes(again, *source, 0, strokes, glm::dvec3(1), 1'000'000);
    EXPECT_EQ(again.strokes, geometry.strokes) << "on any number of threads";
    // Larger than there is room for: wider, and said.
    Geometry few = ballOf(*source);
    addStrokes(few, *source, 0, strokes, glm::dvec3(1), 2000);
    ASSERT_EQ(few.notes.size(), 1u);
    EXPECT_NE(few.notes[0].find("times as wide"), std::string::npos) << few.notes[0];
    EXPECT_LT(few.mesh.positions.size(), 4000u);
    // Of no vector, nothing.
    Geometry none = ballOf(*source);
    strokes.vector = "V";
    addStrokes(none, *source, 0, strokes, glm::dvec3(1), 2000);
    EXPECT_TRUE(none.strokes.empty());
    EXPECT_EQ(none.mesh.positions.size(), coarse);
}

TEST(SurfaceStrokes, AreFaintWhereItIsSlowAndNoneWhereTheVectorIsAbsent) {
    const auto source = turningBall(3);
    Geometry geometry = ballOf(*source);
    addStrokes(geometry, *source, 0, {.vector = "U", .length = 0.2f, .width = 0.03f, .bySpeed = true}, glm::dvec3(1),
               100'000);
    double slow = 0, fast = 0;
    int slowly = 0, quickly = 0;
    for (std::size_t i = 0; i < geometry.strokes.size(); ++i) {
        const glm::dvec3 at = glm::dvec3(geometry.mesh.positions[i]) - kMiddle;
        const double lightness = std::abs(double(geometry.strokes[i]));
        if (at.y > 4.5) {
            ASSERT_EQ(lightness, 0);
            continue;
        }
        if (at.y > 2) continue;
        const double speed = std::hypot(at.x, at.y);
        if (speed < 3) slow += lightness, ++slowly;
        if (speed > 6) fast += lightness, ++quickly;
    }
    ASSERT_GT(slowly, 20);
    ASSERT_GT(quickly, 100);
    EXPECT_LT(slow / slowly, 0.5 * fast / quickly);
}

TEST(SurfaceStrokes, NoiseOfSpaceIsRandomAtCornersAndLinearBetween) {
    double sum = 0, squares = 0;
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; ++i) {
        const double value = spaceNoise({i % 17 - 8, i / 17 % 19, i / 323 - 6}, 3);
        ASSERT_GE(value, -1);
        ASSERT_LT(value, 1);
        sum += value;
        squares += value * value;
    }
    EXPECT_NEAR(sum / kCount, 0, 0.04);
    EXPECT_NEAR(squares / kCount, 1.0 / 3, 0.02);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 a(-3, 5, 2), b = a, middle = a;
        b[axis] += 1;
        middle[axis] += 0.25;
        EXPECT_NEAR(spaceNoise(middle, 3), 0.75 * spaceNoise(a, 3) + 0.25 * spaceNoise(b, 3), 1e-12);
        EXPECT_NE(spaceNoise(a, 3), spaceNoise(b, 3));
    }
    EXPECT_NE(spaceNoise({1, 2, 3}, 3), spaceNoise({1, 2, 3}, 4));
}

} // namespace
} // namespace tessera::vis
