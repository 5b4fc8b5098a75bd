#include "vis/optics/visibility.h"

#include "tests/volume/fields.h"
#include "vis/optics/ray_setup.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace tessera::vis {
namespace {

/// Two slabs: 0.8 where z is greater than the middle, 0.3 behind.
volume::SampleGrid slabs() {
    volume::SampleGrid grid;
    grid.lattice = volume::test::ccLattice({9, 9, 33}, glm::dvec3(1));
    for (int z = 0; z < 33; ++z)
        for (int i = 0; i < 81; ++i) grid.values.push_back(z > 16 ? 0.8f : 0.3f);
    return grid;
}

VisibilityQuery fromTheFront(float front, float behind) {
    VisibilityQuery query;
    query.camera.projection = Projection::Orthographic;
    query.camera.orientation = standardOrientation(StandardView::Front);
    query.camera.fieldOfView = 20;
    query.camera.distance = 0.3f; // the slabs fill the picture
    query.function.opacity = {{0, behind}, {0.5f, behind}, {0.5f, front}, {1, front}};
    query.range = {0, 1};
    query.bins = 4;
    query.rays = 8;
    return query;
}

TEST(VisibilityHistogram, FollowsTheLawOfAbsorption) {
    const volume::SampleGrid grid = slabs();
    const volume::Box bounds = volume::test::boxOf(grid.lattice);
    for (const float opacity : {0.01f, 0.05f, 0.2f}) {
        const auto seen = visibilityHistogram(grid, bounds, fromTheFront(opacity, opacity / 2));
        ASSERT_EQ(seen.size(), 4u);
        // Either slab is half of the longest edge, which is 1, deep.
        const double through = std::pow(1 - double(opacity), 0.5 / kReferenceLength);
        const double second = std::pow(1 - double(opacity) / 2, 0.5 / kReferenceLength);
        EXPECT_NEAR(seen[3], 1 - through, 0.05 * (1 - through)) << "in front";
        EXPECT_NEAR(seen[1], through * (1 - second), 0.05 * through + 1e-5) << "what the front lets through";
        EXPECT_LT(seen[0] + seen[2], 0.04) << "what lies between the slabs";
    }
}

TEST(VisibilityHistogram, WhatIsHiddenIsNotSeen) {
    const volume::SampleGrid grid = slabs();
    const volume::Box bounds = volume::test::boxOf(grid.lattice);
    VisibilityQuery query = fromTheFront(0.9f, 0.9f);
    EXPECT_LT(visibilityHistogram(grid, bounds, query)[1], 1e-2);
    query.camera.orientation = standardOrientation(StandardView::Back);
    const auto behind = visibilityHistogram(grid, bounds, query);
    EXPECT_LT(behind[3], 1e-2);
    EXPECT_NEAR(behind[1], 1, 1e-2);
    query.function.opacity = {{0, 0}, {1, 0}};
    const auto nothing = visibilityHistogram(grid, bounds, query);
    EXPECT_EQ(std::accumulate(nothing.begin(), nothing.end(), 0.0), 0);
}

TEST(VisibilityHistogram, AbsentSamplesAddNothing) {
    volume::SampleGrid grid = slabs();
    grid.present.assign(grid.values.size(), 1);
    for (std::size_t i = 0; i < grid.values.size(); ++i) grid.present[i] = grid.values[i] < 0.5f ? 1 : 0;
    const auto seen = visibilityHistogram(grid, volume::test::boxOf(grid.lattice), fromTheFront(0.9f, 0.9f));
    EXPECT_LT(seen[3], 1e-3);
    EXPECT_NEAR(seen[1], 1, 0.05) << "no longer hidden";
}

} // namespace
} // namespace tessera::vis
