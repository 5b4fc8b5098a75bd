#include "app/ui/ticks.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>

namespace tessera::app {
namespace {

using testing::ElementsAre;

TEST(Ticks, StepsAreOneTwoFive) {
    EXPECT_DOUBLE_EQ(niceStep(10, 5), 2);
    EXPECT_DOUBLE_EQ(niceStep(10, 10), 1);
    EXPECT_DOUBLE_EQ(niceStep(1, 4), 0.5);
    EXPECT_DOUBLE_EQ(niceStep(3.71, 5), 1);
    EXPECT_EQ(niceStep(0, 5), 0);
    EXPECT_EQ(niceStep(std::nan(""), 5), 0);
}

TEST(Ticks, LieInsideTheRangeAndAreNotTooMany) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-12, 12), mantissa(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const double scale = std::pow(10, exponent(random));
        double lo = mantissa(random) * scale, hi = mantissa(random) * scale;
        if (hi < lo) std::swap(lo, hi);
        const int most = 1 + i % 10;
        const std::vector<double> ticks = niceTicks({lo, hi}, most);
        ASSERT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
        const double slack = 1e-5 * (hi - lo);
        for (std::size_t k = 0; k < ticks.size(); ++k) {
            ASSERT_GE(ticks[k], lo - slack);
            ASSERT_LE(ticks[k], hi + slack);
            ASSERT_TRUE(k == 0 || ticks[k] > ticks[k - 1]);
        }
        // A step is at most 2.5 times the wanted one, so two fit into five.
        ASSERT_TRUE(most < 5 || ticks.size() >= 2u) << lo << " " << hi;
    }
}

TEST(Ticks, AreExactDecimals) {
    EXPECT_THAT(niceTicks({0, 0.5}, 5), ElementsAre(0.0, 0.1, 0.2, 0.3, 0.4, 0.5));
    EXPECT_THAT(niceTicks({-0.2, 0.2}, 4), ElementsAre(-0.2, -0.1, 0.0, 0.1, 0.2));
}

TEST(Ticks, SurviveDegenerateRanges) {
    EXPECT_THAT(niceTicks({3, 3}, 5), ElementsAre(3.0));
    EXPECT_TRUE(niceTicks({1, 0}, 5).empty());
    EXPECT_TRUE(niceTicks({std::nan(""), 1}, 5).empty());
    EXPECT_TRUE(niceTicks({0, std::numeric_limits<double>::infinity()}, 5).empty());
    EXPECT_THAT(tickLabels({3, 3}, 5).texts, ElementsAre("3"));
    EXPECT_THAT(fullTickLabels({3, 3}, 5).texts, ElementsAre("3"));
    EXPECT_THAT(fullTickLabels({0, 0.004}, 4).texts, ElementsAre("0.000", "0.001", "0.002", "0.003", "0.004"));
    EXPECT_THAT(fullTickLabels({-1e6, 1e6}, 2).texts, ElementsAre("-1000000", "0", "1000000"));
    EXPECT_THAT(fullTickLabels({-1e-7, 2e-7}, 3).texts, ElementsAre("-1e-7", "0", "1e-7", "2e-7"));
    // A single one.
    EXPECT_THAT(fullTickLabels({-0.3, 0.4}, 1).texts, ElementsAre("0"));
    EXPECT_THAT(fullTickLabels({101325.14, 101325.94}, 2).texts, ElementsAre("101325.5"));
    EXPECT_THAT(fullTickLabels({1234567.1, 1234569.4}, 2).texts, ElementsAre("1234568"));
    EXPECT_THAT(fullTickLabels({0, 3.4e38}, 4).texts, ElementsAre("0", "1e38", "2e38", "3e38"));
    EXPECT_THAT(fullTickLabels({1e9, 1e9 + 2}, 2).texts,
                ElementsAre("1.000000000e9", "1.000000001e9", "1.000000002e9"));
}

TEST(Ticks, LabelsTellNeighboursApart) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> exponent(-9, 9), share(1e-7, 1);
    for (int i = 0; i < 2000; ++i) {
        const double middle = std::pow(10, exponent(random)), span = middle * share(random);
        const TickLabels labels = tickLabels({middle, middle + span}, 6);
        const std::set<std::string> distinct(labels.texts.begin(), labels.texts.end());
        ASSERT_EQ(distinct.size(), labels.texts.size()) << middle << " + " << span;
        for (const std::string& text : labels.texts) ASSERT_LE(text.size(), 9u) << text;
    }
}

TEST(Ticks, FuelCellRanges) {
    EXPECT_THAT(tickLabels({99998, 100016}, 4).texts, ElementsAre("100000", "100005", "100010", "100015"));
    EXPECT_THAT(tickLabels({434.16, 437.87}, 4).texts, ElementsAre("435", "436", "437"));
    const TickLabels fine = tickLabels({100000.2, 100000.9}, 4);
    EXPECT_EQ(fine.note, "+ 100000");
    EXPECT_THAT(fine.texts, ElementsAre("0.2", "0.4", "0.6", "0.8"));
    const TickLabels small = tickLabels({0, 4e-5}, 4);
    EXPECT_EQ(small.note, "\u00d7 1e-6");
    EXPECT_THAT(small.texts, ElementsAre("0", "10", "20", "30", "40"));
}

TEST(Ticks, LabelsGiveTheValueBack) {
    for (const Range range : {Range{99998, 100016}, Range{100000.2, 100000.9}, Range{0, 4e-5}, Range{-3e8, 7e8}}) {
        const TickLabels labels = tickLabels(range, 5);
        double factor = 1, offset = 0;
        std::string note = labels.note;
        if (const auto at = note.find("1e"); at != std::string::npos) factor = std::stod(note.substr(at));
        if (const auto at = note.find("+ "); at != std::string::npos) offset = std::stod(note.substr(at + 2));
        for (std::size_t i = 0; i < labels.values.size(); ++i)
            EXPECT_NEAR(std::stod(labels.texts[i]) * factor + offset, labels.values[i], (range.hi - range.lo) * 1e-6);
    }
}

TEST(Numbers, DigitsFollowTheResolution) {
    EXPECT_EQ(formatNumber(435.1234, 0.01), "435.12");
    EXPECT_EQ(formatNumber(435.1234, 10), "435");
    EXPECT_EQ(formatNumber(-0.001, 0.1), "0.0");
    EXPECT_EQ(formatNumber(0.1 + 0.2), "0.3");
    EXPECT_EQ(formatNumber(1.5e-7, 1e-8), "1.5e-7");
    for (const double resolution : {1e-5, 1e-9, 1e9, 5e-324}) {
        EXPECT_EQ(formatNumber(0, resolution), "0") << resolution;
        EXPECT_EQ(formatNumber(-0.0, resolution), "0") << resolution;
    }
    EXPECT_EQ(formatNumber(4e-19, 1e-5), "0") << "what is left of a difference";
    EXPECT_EQ(formatNumber(-2e-5, 5e-5), "-2e-5");
    EXPECT_EQ(formatNumber(std::nan("")), "absent");
    EXPECT_EQ(formatQuantity(5.28, "mol/m3", 0.01), "5.28 mol/m\u00b3");
    EXPECT_EQ(formatQuantity(std::nan(""), "K", 0.01), "absent");
}

TEST(Numbers, UnitsCountsAndShares) {
    EXPECT_EQ(prettyUnit("A/cm2"), "A/cm\u00b2");
    EXPECT_EQ(prettyUnit("m/s"), "m/s");
    EXPECT_EQ(prettyUnit("m^2"), "m\u00b2");
    EXPECT_EQ(prettyUnit("m^-1"), "m^-1");
    EXPECT_EQ(prettyUnit("m2/s"), "m\u00b2/s");
    EXPECT_EQ(prettyUnit("m24"), "m24") << "not an exponent";
    EXPECT_EQ(prettyUnit("um"), "\u00b5m");
    EXPECT_EQ(prettyUnit("um3"), "\u00b5m\u00b3");
    EXPECT_EQ(prettyUnit("1/um^2"), "1/\u00b5m\u00b2");
    EXPECT_EQ(prettyUnit("sum"), "sum");
    EXPECT_EQ(prettyUnit("umol"), "umol");
    EXPECT_EQ(formatCount(1234567), "1 234 567");
    EXPECT_EQ(formatCount(999), "999");
    EXPECT_EQ(formatShare(0), "0 %");
    EXPECT_EQ(formatShare(1e-9), "< 0.01 %");
    EXPECT_EQ(formatShare(0.042), "4.2 %");
    EXPECT_EQ(formatShare(0.99999), "> 99.9 %");
    EXPECT_EQ(titleWithUnit("T", "K"), "T [K]");
    EXPECT_EQ(titleWithUnit("index", ""), "index");
}

TEST(Numbers, LengthsSuitTheBox) {
    EXPECT_EQ(suitableLength("m", 0.04).name, "mm");
    EXPECT_DOUBLE_EQ(suitableLength("m", 0.04).perUnit, 1000);
    EXPECT_EQ(suitableLength("m", 2e-4).name, "um");
    EXPECT_EQ(suitableLength("m", 0.0009).name, "mm");
    EXPECT_EQ(suitableLength("voxel", 100).name, "voxel");
    EXPECT_EQ(suitableLength("m", 3).name, "m");
    EXPECT_EQ(suitableLength("mm", 0).name, "mm") << "nothing to go by";
    EXPECT_DOUBLE_EQ(suitableLength("mm", 0).perUnit, 1);
}

} // namespace
} // namespace tessera::app
