#include "vis/glyphs/glyph_places.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::vis {
namespace {

const GlyphWeights kEverywhere = [](std::span<const GlyphStand> stands) {
    return std::vector<double>(stands.size(), 1.0);
};

/// The least distance of two, as drawn, by brute force.
double leastDistance(const std::vector<GlyphStand>& stands, glm::dvec3 stretch) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < stands.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, glm::distance(stands[i].place * stretch, stands[j].place * stretch));
    return least;
}

volume::SurfaceMesh squareAtHalf() {
    volume::SurfaceMesh mesh;
    mesh.positions = {{0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TEST(GlyphPlacesTest, NoTwoOverlapAndAllLieInTheBox) {
    const volume::SurfaceMesh surface = squareAtHalf();
    for (const GlyphPlace place : {GlyphPlace::Plane, GlyphPlace::Line, GlyphPlace::Box, GlyphPlace::Surface})
        for (const bool even : {false, true})
            for (const double apart : {0.01, 0.1, 0.4})
                for (const glm::dvec3 stretch : {glm::dvec3(1), glm::dvec3(2, 0.7, 1)}) {
                    GlyphSpace space{.place = place, .even = even, .from = {0.9, 0, 0.1}, .to = {0.1, 1, 0.7}};
                    space.stretch = stretch;
                    space.count = 300;
                    space.apart = apart;
                    space.surface = &surface;
                    const auto stands = placeGlyphs(space, kEverywhere);
                    const std::string what =
                        std::to_string(int(place)) + (even ? " even " : " ") + std::to_string(apart);
                    EXPECT_FALSE(stands.empty()) << what;
                    EXPECT_LE(stands.size(), 300u) << what;
                    EXPECT_GE(leastDistance(stands, stretch), apart * (1 - 1e-9)) << what;
                    for (const GlyphStand& stand : stands) {
                        for (int axis = 0; axis < 3; ++axis) {
                            EXPECT_GE(stand.place[axis], std::min(space.from[axis], space.to[axis]) - 1e-12) << what;
                            EXPECT_LE(stand.place[axis], std::max(space.from[axis], space.to[axis]) + 1e-12) << what;
                        }
                        // A plane lies across z, the thinnest side.
                        EXPECT_TRUE(place != GlyphPlace::Plane || std::abs(stand.place.z - 0.4) < 1e-12) << what;
                        const bool surfaces = place == GlyphPlace::Surface;
                        EXPECT_LT(glm::length(stand.normal - glm::dvec3(0, 0, surfaces)), 1e-12) << what;
                    }
                }
}

TEST(GlyphPlacesTest, BlueNoiseHasTheCountAndCoversTheBox) {
    GlyphSpace space{.place = GlyphPlace::Plane, .from = {0, 0, 0.5}, .to = {1, 1, 0.5}};
    space.count = 400;
    const auto stands = placeGlyphs(space, kEverywhere);
    EXPECT_EQ(stands.size(), 400u);
    // No hole: every point has one within twice the mean distance; and none is much nearer to another than that.
    const double mean = 1 / std::sqrt(400.0);
    for (int y = 0; y <= 40; ++y)
        for (int x = 0; x <= 40; ++x) {
            double nearest = 9;
            for (const GlyphStand& stand : stands)
                nearest = std::min(nearest, glm::distance(stand.place, glm::dvec3(x / 40.0, y / 40.0, 0.5)));
            EXPECT_LT(nearest, 2 * mean);
        }
    EXPECT_GT(leastDistance(stands, glm::dvec3(1)), 0.6 * mean);
    const auto again = placeGlyphs(space, kEverywhere);
    for (std::size_t i = 0; i < stands.size(); ++i) EXPECT_EQ(stands[i].place, again[i].place);
    space.random = 2;
    EXPECT_NE(placeGlyphs(space, kEverywhere)[0].place, stands[0].place);
}

TEST(GlyphPlacesTest, AGridIsEven) {
    GlyphSpace space{.place = GlyphPlace::Plane, .even = true, .from = {0, 0, 0.5}, .to = {2, 1, 0.5}};
    space.count = 200;
    const auto stands = placeGlyphs(space, kEverywhere);
    EXPECT_EQ(stands.size(), 200u) << "20 by 10";
    for (const GlyphStand& stand : stands) {
        double nearest = 9;
        for (const GlyphStand& other : stands)
            if (&other != &stand) nearest = std::min(nearest, glm::distance(stand.place, other.place));
        EXPECT_NEAR(nearest, 0.1, 1e-9);
    }
    space = {.place = GlyphPlace::Box, .even = true};
    space.count = 1000;
    EXPECT_EQ(placeGlyphs(space, kEverywhere).size(), 1000u);
    space.apart = 0.25;
    EXPECT_EQ(placeGlyphs(space, kEverywhere).size(), 64u);
    space.place = GlyphPlace::Line;
    space.apart = 0;
    space.count = 5;
    const auto line = placeGlyphs(space, kEverywhere);
    ASSERT_EQ(line.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(glm::distance(line[i].place, glm::dvec3(double(i) / 4)), 0, 1e-12);
}

TEST(GlyphPlacesTest, TheDensityFollowsTheWeight) {
    const GlyphWeights rising = [](std::span<const GlyphStand> stands) {
        std::vector<double> out;
        for (const GlyphStand& stand : stands) out.push_back(stand.place.x < 0.5 ? 0.25 : stand.place.y < 0.9 ? 1 : 0);
        return out;
    };
    for (const GlyphPlace place : {GlyphPlace::Plane, GlyphPlace::Box}) {
        GlyphSpace space{.place = place};
        space.count = 2000;
        const auto stands = placeGlyphs(space, rising);
        EXPECT_GE(stands.size(), 1900u);
        double low = 0, high = 0, none = 0;
        for (const GlyphStand& stand : stands) (stand.place.x < 0.5 ? low : stand.place.y < 0.9 ? high : none) += 1;
        EXPECT_EQ(none, 0);
        EXPECT_NEAR(low / 0.5 / (high / 0.45), 0.25, 0.06) << int(place);
    }
}

TEST(GlyphPlacesTest, OneStandsAtTheCursor) {
    GlyphSpace space{.place = GlyphPlace::Cursor};
    space.cursor = {0.3, 0.4, 0.9};
    const auto stands = placeGlyphs(space, kEverywhere);
    ASSERT_EQ(stands.size(), 1u);
    EXPECT_EQ(stands[0].place, space.cursor);
    EXPECT_TRUE(placeGlyphs(space, [](auto) { return std::vector<double>{0}; }).empty());
}

TEST(GlyphPlacesTest, ThePlaneLiesAcrossTheThinnestSide) {
    EXPECT_EQ(thinnestAxis({1, 2, 3}), 0);
    EXPECT_EQ(thinnestAxis({2, 1, 1}), 2) << "the last of equal ones";
    EXPECT_EQ(thinnestAxis({1, 0, 3}), 1);
}

} // namespace
} // namespace tessera::vis
