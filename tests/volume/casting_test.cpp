#include "volume/synthetic/casting.h"

#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

TEST(Casting, MaterialsAreWhereThePartHasThem) {
    const Casting scan;
    EXPECT_NEAR(scan({0.99, 0.9, 0.9}), Casting::kAir, 1e-9) << "beside the part";
    EXPECT_NEAR(scan({0.95, 0, 0}), Casting::kAir, 1e-9) << "beside the block, above the flange";
    EXPECT_NEAR(scan({0, 0.7, 0}), Casting::kAir, 1e-9) << "above the block";
    EXPECT_NEAR(scan({0.4, 0, 0}), Casting::kAir, 1e-9) << "in a bore";
    EXPECT_NEAR(scan({-0.4, 0.1, 0.39}), Casting::kAir, 1e-9) << "in the water jacket";
    EXPECT_NEAR(scan({0, 0.05, 0.8}), Casting::kAir, 1e-9) << "in the pipe";
    EXPECT_NEAR(scan({0, 0.05 + 0.14, 0.8}), Casting::kCast, 1e-9) << "its wall";
    EXPECT_NEAR(scan({0.4, 0, -0.5}), Casting::kCast, 1e-9) << "the wall outside of the jacket";
    EXPECT_NEAR(scan({0.4 + 0.27, 0, 0}), Casting::kSteel, 1e-9) << "a liner";
    EXPECT_NEAR(scan({0.86, -0.5, -0.64}), Casting::kSteel, 1e-9) << "a bolt";
    EXPECT_NEAR(scan({0.4 + 0.3, 0, 0}), (Casting::kSteel + Casting::kCast) / 2, 1e-9) << "half and half on a border";
}

// A detector that smears borders over 0.2 sees a place 0.11 below the side of the block, and farther from all else.
TEST(Casting, AWideBorderReachesIntoTheBlock) {
    const Casting scan{.edge = 0.2};
    const double t = (0.11 + 0.2) / 0.4, share = t * t * (3 - 2 * t);
    for (const double x : {-0.73, 0.73})
        for (const double z : {-0.43, 0.43})
            EXPECT_NEAR(scan({x, 0, z}), Casting::kAir + (Casting::kCast - Casting::kAir) * share, 0.01)
                << x << " " << z;
}

TEST(Casting, SamplesAreTheValuesWithinTheNoise) {
    const std::map<std::string, double> size{{"nx", 41}, {"ny", 33}, {"nz", 37}, {"noise", 3}};
    const Dataset made = makeModel("casting", size);
    const Field field = made.read(0, 0, 0), again = makeModel("casting", size).read(0, 0, 0);
    ASSERT_EQ(field.count(), 41u * 33 * 37);
    EXPECT_EQ(field.samples, again.samples) << "the same in each run";
    const Casting scan{.edge = 0.6 * 2 / 32};
    double most = 0;
    for (int k = 0; k < 37; ++k)
        for (int j = 0; j < 33; ++j)
            for (int i = 0; i < 41; ++i) {
                const glm::dvec3 p = glm::dvec3(i, j, k) * 2.0 / glm::dvec3(40, 32, 36) - 1.0;
                most = std::max(most, std::abs(field.value(field.lattice.index({i, j, k})) - scan(p)));
            }
    EXPECT_LE(most, 3.5);
    EXPECT_GT(most, 2);
    EXPECT_THROW(makeModel("casting", {{"times", 2}}), Error);
}

} // namespace
} // namespace tessera::volume
