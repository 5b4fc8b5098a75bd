#include "vis/optics/ray_setup.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Formulas that both shaders and the reference are made of.
namespace tessera::vis {
namespace {

TEST(SlicePlane, LiesAcrossItsAxisOrNormal) {
    const WorldFrame frame = worldFrame({{0, 0, 0}, {4, 8, 2}}, glm::dvec3(1)); // halves of 0.25, 0.5, 0.125
    SliceLayer slice{.channel = "a", .orientation = SliceOrientation::Y, .atCursor = false, .position = 0.75};
    slice.normal = {0.6f, 0, -0.8f};
    Plane plane = slicePlane(slice, frame, {});
    EXPECT_EQ(plane.normal, glm::dvec3(0, 1, 0)) << "the normal is of oblique slices alone";
    EXPECT_NEAR(plane.offset, 0.25, 1e-12);
    slice.orientation = SliceOrientation::Oblique;
    slice.normal *= 3.0f;
    plane = slicePlane(slice, frame, {});
    EXPECT_LT(glm::length(plane.normal - glm::dvec3(0.6, 0, -0.8)), 1e-6);
    EXPECT_NEAR(plane.offset, 0.5 * (0.6 * 0.25 + 0.8 * 0.125), 1e-6) << "half way from the middle to a corner";
    slice.atCursor = true;
    EXPECT_NEAR(slicePlane(slice, frame, {3, 1, 2}).offset, 0.6 * 0.125 - 0.8 * 0.125, 1e-6);
    slice.normal = {};
    EXPECT_EQ(slicePlane(slice, frame, {}).normal, glm::dvec3(0, 0, 1));
}

// A quantised direction is the nearest of a fine grid, in every octant; the axes are on it.
TEST(QuantizedDirection, IsNearAndOnAGrid) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 v(normal(random), normal(random), normal(random));
        const glm::dvec3 found = quantizedDirection(v, 8);
        EXPECT_NEAR(glm::length(found), 1, 1e-12);
        EXPECT_LT(glm::length(quantizedDirection(found, 8) - found), 1e-9) << "stays what it is";
        worst = std::max(worst, glm::length(found - glm::normalize(v)));
    }
    // Half a step of 2 / 255 in x and y, twice that in z, on an octahedron that is 1 / sqrt(3) away.
    EXPECT_LT(worst, std::sqrt(6.0 * 3) / 255);
    EXPECT_GT(worst, 0.5 / 255);
    EXPECT_EQ(quantizedDirection({}, 8), glm::dvec3(0));
}

} // namespace
} // namespace tessera::vis
