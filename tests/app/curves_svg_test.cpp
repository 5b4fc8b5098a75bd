#include "app/views/curves/curves_data.h"

#include <gtest/gtest.h>
#include <limits>
#include <regex>

/// Figures of curves over time, read back: where each state lies on its panel.
namespace tessera::app {
namespace {

struct Box {
    double x = 0, y = 0, width = 0, height = 0;
};

std::vector<double> numbersOf(const std::string& text, const std::string& pattern) {
    std::vector<double> out;
    const std::regex expression(pattern);
    for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
        for (std::size_t i = 1; i < match->size(); ++i) out.push_back(std::stod((*match)[i].str()));
    return out;
}

/// The frames of the panels: rectangles that are not filled.
std::vector<Box> frames(const std::string& svg) {
    const std::vector<double> numbers =
        numbersOf(svg, R"re(<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)" fill="none")re");
    std::vector<Box> out;
    for (std::size_t i = 0; i + 3 < numbers.size(); i += 4)
        out.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
    return out;
}

/// The middles of the dots of a size.
std::vector<glm::dvec2> circles(const std::string& svg, const std::string& radius) {
    const std::vector<double> numbers =
        numbersOf(svg, R"re(<circle cx="([-\d.]+)" cy="([-\d.]+)" r=")re" + radius + "\"");
    std::vector<glm::dvec2> out;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) out.push_back({numbers[i], numbers[i + 1]});
    return out;
}

/// A share 0..1 of a range that is wider than the values by `pad` of them at either end.
double padded(double share, double pad) {
    return (share + pad) / (1 + 2 * pad);
}

TEST(CurvesSvg, EveryStateLiesWhereItsNumbersSay) {
    volume::Curves curves;
    curves.times = {0, 1, 2, 4};
    curves.timeName = "time";
    curves.timeUnit = "s";
    curves.x = {"current", "A", {-20, 0, 60, 30}};
    curves.y = {{"voltage", "V", {0.9, 0.7, 0.1, 0.5}}, {"power", "W", {5, -3, 21, 13}}};
    const std::string svg = svgOf(curvesDrawing(curves, 3.0));
    const std::vector<Box> panels = frames(svg);
    ASSERT_EQ(panels.size(), 2u) << "one for each unit";
    const std::vector<glm::dvec2> dots = circles(svg, "1.80"), marks = circles(svg, "4.50");
    ASSERT_EQ(dots.size(), 8u);
    ASSERT_EQ(marks.size(), 2u);
    const double shares[2][4] = {{1, 0.75, 0, 0.5}, {8.0 / 24, 0, 1, 16.0 / 24}}, across[4] = {0, 0.25, 1, 0.625};
    for (std::size_t panel = 0; panel < 2; ++panel) {
        const Box& box = panels[panel];
        const auto expectAt = [&](glm::dvec2 at, double x, double y, const std::string& what) {
            EXPECT_NEAR(at.x, box.x + box.width * padded(x, 0.04), 0.02) << what;
            EXPECT_NEAR(at.y, box.y + box.height * (1 - padded(y, 0.06)), 0.02) << what;
        };
        for (std::size_t t = 0; t < 4; ++t)
            expectAt(dots[4 * panel + t], across[t], shares[panel][t], "state " + std::to_string(t));
        // Half way from the third time to the fourth.
        expectAt(marks[panel], (across[2] + across[3]) / 2, (shares[panel][2] + shares[panel][3]) / 2, "the mark");
    }
}

TEST(CurvesSvg, CurvesOfOneUnitShareAPanelAndItsRange) {
    volume::Curves curves;
    curves.times = {0, 1};
    curves.x = {"time", "s", {0, 1}};
    curves.y = {{"low", "K", {300, 310}}, {"high", "K", {390, 400}}};
    const std::string svg = svgOf(curvesDrawing(curves, {}));
    const std::vector<Box> panels = frames(svg);
    ASSERT_EQ(panels.size(), 1u);
    const std::vector<glm::dvec2> dots = circles(svg, "1.80");
    ASSERT_EQ(dots.size(), 4u);
    EXPECT_TRUE(circles(svg, "4.50").empty()) << "no time is marked";
    for (const auto& [dot, share] : {std::pair{0u, 0.0}, {1u, 0.1}, {2u, 0.9}, {3u, 1.0}})
        EXPECT_NEAR(dots[dot].y, panels[0].y + panels[0].height * (1 - padded(share, 0.06)), 0.02) << dot;
}

TEST(CurvesSvg, TheVerticalAxisSaysWhatItShows) {
    volume::Curves curves;
    curves.times = {0, 1};
    curves.x = {"time", "s", {0, 1}};
    const auto titled = [&](const std::vector<std::string>& names, const std::string& title) {
        curves.y.clear();
        for (const std::string& name : names) curves.y.push_back({name, "K", {300, 310}});
        EXPECT_NE(svgOf(curvesDrawing(curves, {})).find(">" + title + "</text>"), std::string::npos) << title;
    };
    titled({"mean(T)", "max(T)"}, "T [K]");
    titled({"mean(T)"}, "mean(T) [K]");
    titled({"mean(T)", "max(U)"}, "mean(T), max(U) [K]");
    titled({"min(T)+max(T)", "max(T)"}, "min(T)+max(T), max(T) [K]");
    curves.y = {{"deviation(temperature_of_the_anode)", "K", {0, 1}}, {"mean(T)", "K", {0, 1}}};
    const std::string cut = svgOf(curvesDrawing(curves, {}));
    EXPECT_NE(cut.find(">deviation(temperature_of"), std::string::npos);
    EXPECT_NE(cut.find("... [K]</text>"), std::string::npos);
}

} // namespace
} // namespace tessera::app
