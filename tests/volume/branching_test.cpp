#include "volume/synthetic/branching.h"

#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// A place on the axis of an arm, or of the pipe before the branching.
glm::dvec3 onAxis(double along, bool slow) {
    const glm::dvec3 branching(Branching::kBranchAt, Branching::kBox.y / 2, Branching::kBox.z / 2);
    if (along <= branching.x) return {along, branching.y, branching.z};
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, slow ? -Branching::kSlope : Branching::kSlope, 0));
    return branching + way * (along - branching.x);
}

TEST(Branching, EachPlaceHasItsPulseWhenThatArrives) {
    for (const bool slow : {false, true})
        for (const double along : {0.03, 0.06, 0.13, 0.16}) {
            const glm::dvec3 at = onAxis(along, slow);
            const double arrives = Branching::arrival(along, slow), peak = along < 0.08 ? 8 : 4;
            EXPECT_NEAR(Branching::tracer(at, arrives), peak, 1e-9) << along;
            for (const double beside : {-0.1, 0.1}) EXPECT_LT(Branching::tracer(at, arrives + beside), peak);
        }
    EXPECT_NEAR(Branching::arrival(0.16, true) - Branching::arrival(0.16, false), 0.08 / 0.055 - 0.08 / 0.1, 1e-12);
}

TEST(Branching, IsAbsentOutsideThePipe) {
    const Dataset data = makeModel("branching-pulse", {{"nx", 31}, {"ny", 19}, {"nz", 9}, {"times", 5}});
    const Field field = data.read(1, 0, 3);
    const Lattice& lattice = data.info.lattice;
    int inside = 0;
    for (int k = 0; k < 9; ++k)
        for (int j = 0; j < 19; ++j)
            for (int i = 0; i < 31; ++i) {
                const glm::dvec3 at = lattice.position({i, j, k});
                double away = 1; // from the axes, by brute force
                for (double along = 0; along < 0.25; along += 1e-3)
                    for (const bool slow : {false, true}) away = std::min(away, glm::distance(at, onAxis(along, slow)));
                if (std::abs(away - Branching::kRadius) < 2e-4) continue;
                const std::size_t sample = lattice.index({i, j, k});
                ASSERT_EQ(field.present(sample), away < Branching::kRadius) << i << " " << j << " " << k;
                if (!field.present(sample)) continue;
                ++inside;
                EXPECT_NEAR(field.value(sample), Branching::tracer(at, data.info.times[3]), 1e-5);
                EXPECT_LE(field.value(sample), data.info.parameters[1].ranges[0].hi);
            }
    EXPECT_GT(inside, 200);
    EXPECT_THROW(makeModel("branching-pulse", {{"nx", 2}}), Error);
}

} // namespace
} // namespace tessera::volume
