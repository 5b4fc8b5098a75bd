#include "volume/worth/significance.h"

#include "volume/worth/dependence.h"
#include "volume/worth/differs.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

/// Tails against tables and simulations, and the measures that are tested by them.
namespace tessera::volume {
namespace {

TEST(Significance, TailsAreThoseOfTables) {
    EXPECT_NEAR(normalTails(1.959964), 0.05, 1e-6);
    EXPECT_NEAR(studentTails(2.228139, 10), 0.05, 1e-6);
    EXPECT_NEAR(studentTails(12.7062, 1), 0.05, 1e-6);
    EXPECT_NEAR(studentTails(-1.959964, 1e7), 0.05, 1e-5);
    EXPECT_NEAR(distanceTail(3.841459 - 1), 0.05, 1e-6);
    EXPECT_NEAR(kolmogorovTail(1.3581 / std::sqrt(1e6), 1e6), 0.05, 1e-3);
    EXPECT_NEAR(correlationTail(0.6319, 10), 0.05, 2e-4);
    EXPECT_EQ(correlationTail(1, 5), 0);
    EXPECT_EQ(correlationTail(0.9, 3), 1);
    EXPECT_EQ(correlationTail(std::nan(""), 100), 1);
}

TEST(Significance, RatesAreThoseOfBenjaminiAndHochberg) {
    const std::vector<double> q = falseDiscoveryRates(std::vector<double>{0.01, 0.04, 0.03, 0.5, std::nan("")});
    const std::vector<double> expected{0.05, 0.2 / 3, 0.2 / 3, 0.625, 1};
    ASSERT_EQ(q.size(), expected.size());
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], expected[i], 1e-12) << i;
}

TEST(Significance, NoiseIsNeverFarOut) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<float> away(50000);
    for (float& each : away) each = std::abs(normal(random));
    std::ranges::sort(away);
    EXPECT_GT(expectedBeyond(away, double(away.back()), double(away.size()), 0), 1);
    EXPECT_LT(expectedBeyond(away, 40, double(away.size()), 0), 1e-6);
}

TEST(DistanceCorrelation, FindsWhatRDoesNot) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> even(-1, 1);
    std::vector<double> x(300), square, noise;
    for (double& each : x) each = even(random);
    for (const double each : x) {
        square.push_back(each * each);
        noise.push_back(even(random));
    }
    EXPECT_NEAR(distanceCorrelation(x, x), 1, 1e-12);
    EXPECT_GT(distanceCorrelation(x, square), 0.15);
    EXPECT_LT(distanceTail(300 * distanceCorrelation(x, square)), 1e-6);
    EXPECT_NEAR(distanceCorrelation(x, noise), 0, 0.02);
    EXPECT_TRUE(std::isnan(distanceCorrelation(x, std::vector<double>(300, 1.0))));
}

/// The tail of the chi-square test against permutations of the pairs themselves.
TEST(DistanceCorrelation, ItsChanceIsThatOfPermutations) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::vector<double> x(40), y(40);
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = normal(random);
        y[i] = 0.5 * std::abs(x[i]) + normal(random);
    }
    std::vector<double> chances;
    for (int i = 0; i < 2000; ++i) {
        std::ranges::shuffle(y, random);
        chances.push_back(distanceTail(40 * distanceCorrelation(x, y)));
    }
    for (const double level : {0.05, 0.01}) {
        const double share =
            double(std::ranges::count_if(chances, [&](double p) { return p <= level; })) / double(chances.size());
        EXPECT_LE(share, 1.6 * level) << level;
        EXPECT_GE(share, 0.2 * level) << level;
    }
}

TEST(KolmogorovDistance, IsTheGreatestDifferenceOfShares) {
    std::vector<float> a{1, 2, 3, 4}, b{3, 4, 5, 6};
    EXPECT_DOUBLE_EQ(kolmogorovDistance(a, b), 0.5);
    std::vector<float> c{2, 1}, d{1, 2};
    EXPECT_DOUBLE_EQ(kolmogorovDistance(c, d), 0);
    std::vector<float> e{1}, f{2, 3};
    EXPECT_DOUBLE_EQ(kolmogorovDistance(e, f), 1);
}

} // namespace
} // namespace tessera::volume
