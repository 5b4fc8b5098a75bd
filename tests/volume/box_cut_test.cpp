#include "volume/flow/box_cut.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

TEST(BoxCut, IsExact) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> even(-1, 1);
    for (int i = 0; i < 40; ++i) {
        glm::dvec3 normal(even(random), even(random), even(random));
        if (i % 4 == 1) normal.x = 0;
        if (i % 4 == 2) normal = {0, 0, normal.z};
        normal = glm::normalize(normal);
        const glm::dvec3 lo(even(random), even(random), even(random)),
            size(0.1 + std::abs(even(random)), 1e-3 + std::abs(even(random)), 2 + even(random));
        const BoxCut cut(normal, lo, lo + size);
        const double whole = size.x * size.y * size.z;
        EXPECT_EQ(cut.volume(cut.first() - 1), 0);
        EXPECT_NEAR(cut.volume(cut.last() + 1), whole, 1e-14);
        for (const double share : {0.01, 0.2, 0.5, 0.77, 0.99}) {
            const double s = cut.first() + share * (cut.last() - cut.first()), h = 1e-6 * (cut.last() - cut.first());
            constexpr int kN = 40;
            int below = 0;
            for (int x = 0; x < kN; ++x)
                for (int y = 0; y < kN; ++y)
                    for (int z = 0; z < kN; ++z)
                        below += glm::dot(normal, lo + size * (glm::dvec3(x, y, z) + 0.5) / double(kN)) <= s ? 1 : 0;
            EXPECT_NEAR(cut.volume(s), whole * below / (kN * kN * kN), 0.04 * whole);
            EXPECT_NEAR(cut.area(s), (cut.volume(s + h) - cut.volume(s - h)) / (2 * h), 1e-3 * cut.area(s) + 1e-6);
        }
    }
}

TEST(BoxCut, GrowsWithTheBox) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, -2, 0.5)), lo(0.2, -1, 3), size(1.5, 0.25, 2);
    const BoxCut one(normal, lo, lo + size);
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
        const BoxCut cut(normal, lo * scale, (lo + size) * scale);
        EXPECT_NEAR(cut.first(), one.first() * scale, 1e-12 * scale);
        EXPECT_NEAR(cut.last(), one.last() * scale, 1e-12 * scale);
        for (const double share : {0.1, 0.4, 0.9}) {
            const double s = one.first() + share * (one.last() - one.first());
            EXPECT_NEAR(cut.volume(s * scale) / std::pow(scale, 3), one.volume(s), 1e-9);
            EXPECT_NEAR(cut.area(s * scale) / std::pow(scale, 2), one.area(s), 1e-9);
        }
    }
}

} // namespace
} // namespace tessera::volume
