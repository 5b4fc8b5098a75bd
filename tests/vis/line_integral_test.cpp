#include "vis/lic/line_integral.h"

#include "vis/lic/make_strokes.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <numbers>

/// Line integral convolution against sums by hand, by its symmetries and by its statistics; strokes made of data.
namespace tessera::vis {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

PlaneField planeField(glm::ivec2 size, const std::function<glm::dvec2(glm::dvec2)>& vector) {
    PlaneField field{size, {}};
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) field.vectors.emplace_back(vector(glm::dvec2(x, y) + 0.5));
    return field;
}

/// White noise.
std::vector<float> whiteNoise(glm::ivec2 size) {
    return planeNoise(size, {0, 0}, 1, 7);
}

double correlation(const std::vector<std::pair<double, double>>& pairs) {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    const auto count = double(pairs.size());
    for (const auto& [x, y] : pairs) a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    return (ab - a * b / count) / std::sqrt((aa - a * a / count) * (bb - b * b / count));
}

/// Of texels that lie (x, y) apart, away from the border.
double correlationAt(const std::vector<float>& picture, glm::ivec2 size, int x, int y, int border) {
    std::vector<std::pair<double, double>> pairs;
    for (int j = border; j < size.y - border - y; ++j)
        for (int i = border; i < size.x - border - x; ++i)
            pairs.emplace_back(picture[std::size_t(j * size.x + i)], picture[std::size_t((j + y) * size.x + i + x)]);
    return correlation(pairs);
}

TEST(LineIntegral, UniformFlowGivesStrokesAsLongAsTheKernelAndOneTexelWide) {
    const glm::ivec2 size(260, 120);
    constexpr int kLength = 20;
    const PlaneField field = planeField(size, [](glm::dvec2) { return glm::dvec2(3, 0); });
    const auto box = lineIntegralConvolution(field, whiteNoise(size), {kLength, StrokeKernel::Box});
    for (const int lag : {1, 5, 10, 15}) // means of kLength + 1 texels of which that many fewer are shared
        EXPECT_NEAR(correlationAt(box, size, lag, 0, kLength), 1 - lag / (kLength + 1.0), 0.07) << lag;
    for (const int lag : {kLength + 2, kLength + 10}) EXPECT_NEAR(correlationAt(box, size, lag, 0, kLength), 0, 0.07);
    EXPECT_NEAR(correlationAt(box, size, 0, 1, kLength), 0, 0.07) << "rows know nothing of each other";
    const auto hann = lineIntegralConvolution(field, whiteNoise(size), {kLength, StrokeKernel::Hann});
    const auto weight = [](int i) {
        return std::max(0.0, 0.5 + 0.5 * std::cos(std::numbers::pi * i / (kLength / 2.0)));
    };
    for (const int lag : {2, 5, 10, 15}) {
        double both = 0, own = 0;
        for (int i = -kLength / 2; i <= kLength / 2; ++i) {
            both += i + lag <= kLength / 2 ? weight(i) * weight(i + lag) : 0;
            own += weight(i) * weight(i);
        }
        EXPECT_NEAR(correlationAt(hann, size, lag, 0, kLength), both / own, 0.07) << lag;
    }
}

TEST(LineIntegral, ContrastIsTheStatedOne) {
    const glm::ivec2 size(150, 140);
    const PlaneField field = planeField(size, [](glm::dvec2 p) { return glm::dvec2(p.y - 70, 75 - p.x); });
    const auto picture = lineIntegralConvolution(field, whiteNoise(size), {30});
    double sum = 0, squares = 0;
    for (const float value : picture) {
        EXPECT_LE(std::abs(value), 1);
        sum += double(value);
        squares += double(value) * double(value);
    }
    const double mean = sum / double(picture.size());
    EXPECT_NEAR(mean, 0, 0.02);
    EXPECT_NEAR(std::sqrt(squares / double(picture.size()) - mean * mean), kStrokeDeviation, 0.02);
}

TEST(LineIntegral, StrokesOfARotationRunInCircles) {
    const glm::ivec2 size(181, 181);
    const glm::dvec2 middle = glm::dvec2(size) / 2.0;
    const PlaneField field = planeField(size, [&](glm::dvec2 p) { return glm::dvec2(middle.y - p.y, p.x - middle.x); });
    const auto picture = lineIntegralConvolution(field, whiteNoise(size), {40});
    const auto at = [&](double radius, double angle) {
        const glm::dvec2 place = middle + radius * glm::dvec2(std::cos(angle), std::sin(angle));
        return double(picture[std::size_t(place.y) * std::size_t(size.x) + std::size_t(place.x)]);
    };
    // Of every sector alike, whatever its direction.
    for (int sector = 0; sector < 8; ++sector) {
        std::vector<std::pair<double, double>> along, across;
        for (double radius = 25; radius < 80; radius += 1)
            for (double turn = 0; turn < 0.75; turn += 1.5 / radius) {
                const double angle = (sector + turn / 0.75) * 0.785398;
                along.emplace_back(at(radius, angle), at(radius, angle + 5 / radius));
                across.emplace_back(at(radius, angle), at(radius + 5, angle));
            }
        EXPECT_GT(correlation(along), 0.6) << sector;
        EXPECT_LT(correlation(across), 0.3) << sector;
    }
}

TEST(LineIntegral, TurnsWithFieldAndNoise) {
    const glm::ivec2 size(96, 70);
    const auto vector = [](glm::dvec2 p) { return glm::dvec2(std::sin(p.y / 9), std::cos(p.x / 13) + 0.2); };
    PlaneField field = planeField(size, vector);
    for (int i = 0; i < 12; ++i) field.vectors[field.index({30 + i, 20 + i / 3})] = glm::vec2(kNoNumber);
    const std::vector<float> noise = whiteNoise(size);
    // By 90 degrees: (x, y) comes to (height - 1 - y, x).
    PlaneField turned{{size.y, size.x}, std::vector<glm::vec2>(field.vectors.size())};
    std::vector<float> turnedNoise(noise.size());
    const auto place = [&](int x, int y) { return turned.index({size.y - 1 - y, x}); };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const glm::vec2 own = field.vectors[field.index({x, y})];
            turned.vectors[place(x, y)] = {-own.y, own.x};
            turnedNoise[place(x, y)] = noise[field.index({x, y})];
        }
    const auto one = lineIntegralConvolution(field, noise, {24});
    const auto other = lineIntegralConvolution(turned, turnedNoise, {24});
    int differ = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float a = one[field.index({x, y})], b = other[place(x, y)];
            EXPECT_EQ(std::isnan(a), std::isnan(b));
            if (!std::isnan(a)) differ += std::abs(a - b) > 1e-5f;
        }
    EXPECT_LE(differ, 4) << "but for lines that end at the edge of a texel, by rounding";
}

/// How far b is from any a * factor + offset, of what is present in both: the contrast of a whole is stretched.
double apartFromLinear(const std::vector<std::pair<double, double>>& pairs) {
    return std::sqrt(std::max(0.0, 1 - std::pow(correlation(pairs), 2)));
}

TEST(LineIntegral, NothingIsConvolvedThroughAbsentTexelsAndBordersOfParts) {
    const glm::ivec2 size(80, 30);
    const PlaneField open = planeField(size, [](glm::dvec2) { return glm::dvec2(1, 0.02); });
    PlaneField wall = open, parts = open;
    parts.parts.assign(open.vectors.size(), 0);
    for (int y = 0; y < size.y; ++y) {
        wall.vectors[wall.index({40, y})] = glm::vec2(kNoNumber);
        for (int x = 40; x < size.x; ++x) parts.parts[parts.index({x, y})] = 1;
    }
    const std::vector<float> noise = whiteNoise(size);
    std::vector<float> changed = noise; // right of the wall
    for (int y = 0; y < size.y; ++y)
        for (int x = 42; x < size.x; ++x) changed[open.index({x, y})] *= -0.5f;
    const auto apart = [&](const PlaneField& field) {
        const auto one = lineIntegralConvolution(field, noise, {30}),
                   other = lineIntegralConvolution(field, changed, {30});
        std::vector<std::pair<double, double>> pairs;
        for (int y = 0; y < size.y; ++y)
            for (int x = 28; x < 39; ++x) {
                const std::size_t i = field.index({x, y});
                if (std::abs(one[i]) < 1 && std::abs(other[i]) < 1) pairs.emplace_back(one[i], other[i]);
            }
        return apartFromLinear(pairs);
    };
    EXPECT_LT(apart(wall), 1e-3);
    EXPECT_LT(apart(parts), 0.02) << "noise alone is read across the edge, half a texel wide";
    EXPECT_GT(apart(open), 0.1);
    const auto picture = lineIntegralConvolution(wall, noise, {30});
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) EXPECT_EQ(std::isnan(picture[wall.index({x, y})]), x == 40);
}

TEST(LineIntegral, WhereNothingFlowsThereIsTheNoise) {
    const glm::ivec2 size(40, 40);
    const PlaneField still = planeField(size, [](glm::dvec2) { return glm::dvec2(0); });
    const std::vector<float> noise = whiteNoise(size);
    const auto picture = lineIntegralConvolution(still, noise, {30});
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i < noise.size(); ++i) pairs.emplace_back(noise[i], picture[i]);
    EXPECT_GT(correlation(pairs), 0.9999);
}

TEST(LineIntegral, NoiseBelongsToItsTexel) {
    const auto whole = planeNoise({40, 30}, {-20, -11}, 3, 5), part = planeNoise({17, 9}, {-7, -2}, 3, 5);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 17; ++x)
            EXPECT_EQ(part[std::size_t(y * 17 + x)], whole[std::size_t((y + 9) * 40 + x + 13)]);
    EXPECT_NE(planeNoise({17, 9}, {-7, -2}, 3, 6), part);
    const auto [least, most] = std::minmax_element(whole.begin(), whole.end());
    EXPECT_LT(*least, -0.5f);
    EXPECT_GT(*most, 0.5f);
}

/// U = (1, 0.5, 0.25) everywhere but where x > 12, in a box of edges 16, 8 and 4.
std::shared_ptr<const volume::BrickSource> evenWind() {
    volume::Dataset data;
    data.info.lattice.size = {17, 9, 5};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(16, 8, 4)};
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "U";
    data.info.parameters[0].components = 3;
    data.info.parameters[0].ranges = {{1, 1}, {0.5, 0.5}, {0.25, 0.25}, {1.2, 1.2}};
    data.read = [lattice = data.info.lattice](int, int component, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        for (std::size_t i = 0; i < field.count(); ++i) {
            field.as<float>()[i] = component == 0 ? 1.0f : component == 1 ? 0.5f : 0.25f;
            (*mask)[i] = i % 17 <= 12;
        }
        field.mask = mask;
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

TEST(MakeStrokes, SampleThePartInThePlaneAsDrawn) {
    const auto source = evenWind();
    const WorldFrame frame = worldFrame(source->info(), {1, 2, 3}); // 16 x 16 x 12
    const StrokeRoom room = strokeRoom({{0, 0, 1}, 0.1}, frame, 0.01);
    EXPECT_EQ(room.size, glm::ivec2(100));
    EXPECT_NEAR(room.middleOf({0, 0}).x, -0.495, 1e-9);
    EXPECT_NEAR(room.middleOf({0, 0}).z, 0.1, 1e-12);
    const StrokeSamples samples = sampleStrokes(source, 0, 0, room, frame);
    int present = 0;
    for (std::size_t i = 0; i < samples.field.vectors.size(); ++i) {
        const glm::vec2 own = samples.field.vectors[i];
        const bool there = frame.toPhysical(room.middleOf({int(i % 100), int(i / 100)})).x < 12.5;
        EXPECT_EQ(std::isnan(own.x), !there) << i;
        if (!there) continue;
        ++present;
        EXPECT_NEAR(own.y / own.x, 1, 1e-6) << "0.5, twice as long as drawn";
        EXPECT_NEAR(samples.speed[i], std::sqrt(1.25), 1e-6);
    }
    EXPECT_GT(present, 7000);
}

TEST(MakeStrokes, PlanesBehindEachOtherShareTheirNoise) {
    const auto source = evenWind();
    Strokes strokes;
    strokes.vector = "U";
    strokes.width = 0.02f;
    const auto one = makeStrokes(source, strokes, 0, {{0, 0, 1}, 0.02}, glm::dvec3(1));
    const auto other = makeStrokes(source, strokes, 0, {{0, 0, 1}, -0.07}, glm::dvec3(1));
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->texels, other->texels) << "the flow is the same in both";
    EXPECT_NEAR(one->corner.z, 0.02, 1e-12);
    // Texels are where the map says.
    const std::size_t texel = 23 * std::size_t(one->size.x) + 11;
    const glm::dvec3 middle = one->corner + (one->right * 11.5 + one->up * 23.5) * one->texel;
    EXPECT_NEAR(sliceStrokes(*one, middle).x, double(one->texels[texel].x), 1e-6);
    EXPECT_NEAR(sliceStrokes(*one, middle + one->right * (0.25 * one->texel)).x,
                std::lerp(double(one->texels[texel].x), double(one->texels[texel + 1].x), 0.25), 1e-6);
    EXPECT_EQ(sliceStrokes(*one, {0.45, 0, 0.02}).y, 0) << "no strokes where the vector is absent";
    strokes.vector = "V";
    EXPECT_FALSE(makeStrokes(source, strokes, 0, {{0, 0, 1}, 0}, glm::dvec3(1)));
    strokes.vector = "U";
    EXPECT_FALSE(makeStrokes(source, strokes, 0, {{0, 0, 1}, 0.9}, glm::dvec3(1))) << "the plane misses the data";
}

TEST(MakeStrokes, TiltedPlanesFollowTheFlow) {
    const auto source = evenWind();
    const WorldFrame frame = worldFrame(source->info(), glm::dvec3(1));
    const Plane plane{glm::normalize(glm::dvec3(0.3, -0.4, 0.86)), 0.01};
    const StrokeRoom room = strokeRoom(plane, frame, 0.02);
    EXPECT_NEAR(glm::dot(room.right, plane.normal), 0, 1e-12);
    EXPECT_NEAR(glm::dot(room.up, plane.normal), 0, 1e-12);
    EXPECT_NEAR(glm::dot(room.up, room.right), 0, 1e-12);
    const glm::dvec3 wind(1, 0.5, 0.25), flat = wind - plane.normal * glm::dot(wind, plane.normal);
    const StrokeSamples samples = sampleStrokes(source, 0, 0, room, frame);
    int present = 0;
    for (std::size_t i = 0; i < samples.speed.size(); ++i) {
        const glm::dvec2 own(samples.field.vectors[i]);
        if (std::isnan(own.x)) continue;
        ++present;
        const glm::dvec3 along = room.right * own.x + room.up * own.y;
        EXPECT_LT(glm::length(glm::normalize(along) - glm::normalize(flat)), 1e-6);
        EXPECT_NEAR(samples.speed[i], glm::length(flat), 1e-6);
    }
    EXPECT_GT(present, 300);
}

} // namespace
} // namespace tessera::vis
