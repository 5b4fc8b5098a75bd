#include "app/ui/time_text.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

volume::DatasetInfo infoOf(std::vector<double> times, std::string name, std::string unit) {
    volume::DatasetInfo info;
    info.times = std::move(times);
    info.timeName = std::move(name);
    info.timeUnit = std::move(unit);
    return info;
}

TEST(TimeText, SaysWhatTheTimesCount) {
    EXPECT_EQ(timeText(infoOf({0.01, 0.02, 0.26}, "time", "s"), 0.26), "t = 0.26 s");
    EXPECT_EQ(timeText(infoOf({1, 2, 11}, "operating point", ""), 11), "operating point 11");
    EXPECT_EQ(timeText(infoOf({0.4, 0.62}, "voltage", "V"), 0.62), "voltage 0.62 V");
    EXPECT_EQ(timeText(infoOf({1, 2, 11}, "time", ""), 11), "t = 11"); // no unit is invented
    EXPECT_EQ(timeTitle(infoOf({1, 2}, "time", "ms")), "t [ms]");
    EXPECT_EQ(timeTitle(infoOf({1, 2}, "operating point", "")), "operating point");
    // Between stored times with one digit more.
    EXPECT_EQ(timeText(infoOf({1, 2, 11}, "time", "s"), 1.54321), "t = 1.5 s");
}

TEST(TimeText, QuantitiesStandBesideTheTime) {
    volume::DatasetInfo info = infoOf({1, 2, 3}, "operating point", "");
    info.quantities = {{"voltage", "V", {0.7, 0.62, 0.5}},
                       {"current density", "A/m^2", {4000, 17439, 25000}},
                       {"utilisation", "", {0.5, std::nan(""), 0.7}}};
    EXPECT_EQ(quantitiesText(info, 2), "0.62 V, 17 439 A/m\u00b2");
    EXPECT_EQ(quantitiesText(info, 1), "0.7 V, 4000 A/m\u00b2, utilisation 0.5");
    EXPECT_EQ(quantitiesText(info, 2, "current density"), "17 439 A/m\u00b2, 0.62 V");
    EXPECT_EQ(quantitiesText(info, 1, {}, 1), "0.7 V, ...");
    EXPECT_EQ(quantitiesText(info, 1.5, {}, 1), "0.66 V, ...");
    EXPECT_EQ(stateText(info, 2), "operating point 2   0.62 V, 17 439 A/m\u00b2");
    info.quantities.clear();
    EXPECT_EQ(stateText(info, 2), "operating point 2");
}

} // namespace
} // namespace tessera::app
