#include "app/session/session_json.h"
#include "tests/app/formula_view.h"
#include "tests/app/table_text.h"

#include <cmath>
#include <map>

/// What parallel coordinates and the cloud over three parameters export, read back and counted again.
namespace tessera::app {
namespace {

using formula::Place;

Range drawnRange(const std::string& channel) {
    const Range range = formula::rangeOf(channel);
    const double margin = 0.02 * (range.hi - range.lo);
    return {range.lo - margin, range.hi + margin};
}

int binOf(const std::string& channel, double value, int bins) {
    const Range range = drawnRange(channel);
    return std::min(bins - 1, int((value - range.lo) / (range.hi - range.lo) * bins));
}

template <class Shape> std::size_t shapesIn(const VectorPage& page) {
    return std::size_t(std::ranges::count_if(
        page.marks, [](const shapes::Mark& mark) { return std::holds_alternative<Shape>(mark.shape); }));
}

class ParallelExports : public FormulaView {
protected:
    static ParallelCoordinatesView someView() {
        ParallelCoordinatesView view;
        view.channels = {"T", "c", "|U|"};
        view.bins = 19;
        return view;
    }
    static Session warm(Session session) {
        session.selection.brushes = {vis::rangeBrush({{.channel = "T", .lo = 318.5, .hi = 1e9}}, "warm")};
        return session;
    }
};

TEST_F(ParallelExports, TheTableHasEveryPairOfBins) {
    install(someView());
    for (const bool brushed : {false, true}) {
        const TableText read = tableOf(table(brushed ? warm(start) : start));
        std::map<std::array<int, 4>, std::array<double, 2>> wanted; // gap, bins (-1: absent): samples, selected
        const std::string names[] = {"T", "c", "|U|"};
        formula::forEachPlace([&](Place at) {
            for (int gap = 0; gap < 2; ++gap) {
                std::array<int, 4> key{gap, -1, -1, 0};
                for (int side = 0; side < 2; ++side)
                    if (const auto v = formula::value(names[gap + side], at, 1))
                        key[std::size_t(1 + side)] = binOf(names[gap + side], double(*v), 19);
                wanted[key][0] += 1;
                wanted[key][1] += *formula::value("T", at, 1) >= 318.5f ? 1 : 0;
            }
        });
        EXPECT_EQ(read.rows.size(), wanted.size());
        for (std::size_t row = 0; row < read.rows.size(); ++row) {
            std::array<int, 4> key{read.text(row, "left parameter") == "T" ? 0 : 1, -1, -1, 0};
            for (const bool right : {false, true}) {
                const std::string side = right ? "right " : "left ", name = read.text(row, side + "parameter");
                const auto from = read.number(row, side + "from"), to = read.number(row, side + "to");
                EXPECT_EQ(from.has_value(), to.has_value());
                if (from) key[right ? 2 : 1] = binOf(name, (*from + *to) / 2, 19);
                if (from) {
                    const Range range = drawnRange(name);
                    EXPECT_NEAR(*to - *from, (range.hi - range.lo) / 19, 1e-6 * range.hi);
                }
            }
            ASSERT_TRUE(wanted.contains(key)) << row;
            EXPECT_EQ(read.number(row, "samples"), wanted[key][0]) << row;
            if (brushed) {
                EXPECT_EQ(read.number(row, "samples in warm"), wanted[key][1]) << row;
            }
        }
    }
}

TEST_F(ParallelExports, TheFigureHasAPictureForEachGapAndTextsForEachAxis) {
    install(someView());
    picture(start);
    const ViewExport* offered = workbench.exported("pane");
    ASSERT_TRUE(offered && offered->figure);
    const VectorPage page = offered->figure({.size = {480, 300}, .text = 8}, {});
    EXPECT_EQ(page.size, glm::dvec2(480, 300));
    EXPECT_EQ(shapesIn<shapes::Picture>(page), 2u);
    std::vector<std::string> texts;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* words = std::get_if<shapes::Words>(&mark.shape)) {
            texts.push_back(words->text);
            EXPECT_GE(words->at.y, 0) << words->text;
            EXPECT_LE(words->at.y, 300) << words->text;
        }
    for (const char* wanted : {"T [K]", "c [mol/m\u00b3]", "|U| [m/s]", "absent"})
        EXPECT_NE(std::ranges::find(texts, wanted), texts.end()) << wanted;
    ParallelCoordinatesView several = someView();
    several.times = {0, 0.5, 2};
    install(several);
    picture(start);
    const VectorPage states = workbench.exported("pane")->figure({}, {});
    EXPECT_EQ(shapesIn<shapes::Picture>(states), 6u);
    const TableText read = tableOf(table(start));
    double samples = 0;
    for (std::size_t row = 0; row < read.rows.size(); ++row)
        if (read.text(row, "left parameter") == "T") samples += *read.number(row, "samples");
    EXPECT_EQ(samples, 3 * 8 * 7 * 9);
}

TEST_F(ParallelExports, SessionsKeepEverySetting) {
    ParallelCoordinatesView view = someView();
    view.flipped = {"c"}, view.logarithmic = {"T"}, view.zoom["|U|"] = {1, 2};
    view.times = {0, 2}, view.byCorrelation = true, view.histograms = false, view.logDensity = false;
    Session session;
    session.views["a"] = view;
    Scatter3dView cloud;
    cloud.channels = {"T", "c", "|U|"}, cloud.turn = {12, -3}, cloud.bins = 40, cloud.logDensity = false;
    session.views["b"] = cloud;
    const Session read = sessionFromJson(toJson(session), "");
    EXPECT_TRUE(std::get<ParallelCoordinatesView>(read.views.at("a")) == view);
    EXPECT_TRUE(std::get<Scatter3dView>(read.views.at("b")) == cloud);
}

TEST_F(ParallelExports, TheCloudCountsTriplesOfBins) {
    Scatter3dView view;
    view.channels = {"T", "|U|", "c"};
    view.bins = 16;
    install(view);
    const TableText read = tableOf(table(warm(start)));
    std::map<std::array<int, 3>, std::array<double, 2>> wanted;
    formula::forEachPlace([&](Place at) {
        const auto c = formula::value("c", at, 1);
        if (!c) return;
        const double t = double(*formula::value("T", at, 1));
        auto& [samples, selected] = wanted[{binOf("T", t, 16), binOf("|U|", double(*formula::value("|U|", at, 1)), 16),
                                            binOf("c", double(*c), 16)}];
        samples += 1, selected += t >= 318.5 ? 1 : 0;
    });
    ASSERT_EQ(read.rows.size(), wanted.size());
    for (std::size_t row = 0; row < read.rows.size(); ++row) {
        const std::array<int, 3> key{binOf("T", *read.number(row, "T [K]"), 16),
                                     binOf("|U|", *read.number(row, "|U| [m/s]"), 16),
                                     binOf("c", *read.number(row, "c [mol/m3]"), 16)};
        ASSERT_TRUE(wanted.contains(key)) << row;
        EXPECT_EQ(read.number(row, "samples"), wanted[key][0]);
        EXPECT_EQ(read.number(row, "samples in warm"), wanted[key][1]);
    }
}

} // namespace
} // namespace tessera::app
