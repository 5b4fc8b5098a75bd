#include "app/edits/show_parameter.h"
#include "app/pane/choose_times.h"
#include "app/ui/time_text.h"
#include "app/views/curves/curves_data.h"
#include "app/views/curves/profile_data.h"
#include "app/views/curves/section_data.h"
#include "tests/app/formula_cell.h"
#include "volume/base/error.h"
#include "volume/flow/flow_channels.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <gtest/gtest.h>

/// Several times, selections and regions in one plot; two units over one axis; what is shown of a difference.
namespace tessera::app {
namespace {

volume::DatasetInfo operatingPoints() {
    volume::DatasetInfo info;
    info.times = {1, 2, 3, 4};
    info.timeName = "operating point";
    info.timeUnit.clear();
    info.quantities = {{"voltage", "V", {0.85, 0.75, 0.6, 0.6}}, {"current", "A/m2", {100, 5000, 17439, 18000}}};
    return info;
}

TEST(SeveralStates, ALegendNamesThemByWhatTellsThemApart) {
    volume::DatasetInfo info = operatingPoints();
    using Names = std::vector<std::string>;
    EXPECT_EQ(stateNames(info, {1, 3}), (Names{"0.85 V", "0.6 V"}));
    EXPECT_EQ(stateNames(info, {3, 4})[1], "18 000 A/m\u00b2") << "both are at 0.6 V";
    info.quantities.clear();
    EXPECT_EQ(stateNames(info, {1, 3}), (Names{"operating point 1", "operating point 3"}));
    info = operatingPoints();
    info.timeName = "time";
    info.timeUnit = "s";
    EXPECT_EQ(stateNames(info, {3, 4}), (Names{"3 s, 0.6 V", "4 s, 0.6 V"}));
    info.timeName = "voltage";
    info.timeUnit = "V";
    EXPECT_EQ(stateNames(info, {1, 2}), (Names{"1 V", "2 V"}));
}

TEST(SeveralStates, TimesAreThoseOfTheDataInOrder) {
    const volume::DatasetInfo info = operatingPoints();
    const auto chosen = [&](std::vector<double> times) {
        std::vector<double> out;
        for (const volume::TimePair& pair : chosenTimes(info, times, 2))
            out.push_back(volume::timeAt(info.times, pair));
        return out;
    };
    EXPECT_EQ(chosen({}), (std::vector<double>{2}));
    EXPECT_EQ(chosen({4, 1, 4, 9, 2.5}), (std::vector<double>{1, 2.5, 4}));
    EXPECT_EQ(chosen({-1, 9}), (std::vector<double>{2})) << "of other data";
}

class StatesOfACell : public testing::Test {
protected:
    std::shared_ptr<const volume::BrickSource> source = volume::makeMemorySource(formula::makeCell(), {});
    const volume::DatasetInfo& info = source->info();
    int channel(const char* name) const { return *info.findChannel(name); }
    SectionCurvesQuery across(int time) const {
        SectionCurvesQuery query;
        query.channels = {channel("T"), channel("c")};
        query.axis = volume::SpaceAxis::Z;
        query.label = channel("region");
        query.time = {time, time, 0};
        return query;
    }
    /// Mean over a plane by the formula, every sample weighted by its cell.
    static double mean(const char* name, int z, int time, int region) {
        double sum = 0, all = 0;
        formula::forEachPlace([&](formula::Place at) {
            if (at.z != z || formula::region(at) != region) return;
            const double area = formula::cellShare({at.x, at.y, 4});
            if (const auto value = formula::value(name, at, time)) sum += area * double(*value), all += area;
        });
        return sum / all;
    }
};

TEST_F(StatesOfACell, SectionAveragesAreAFamilyForEachRegion) {
    const std::vector<SectionCurves> states{readSections(source, across(0)), readSections(source, across(2))};
    const std::vector<Plot> panels = sectionPanels(info, states, SectionMeasure::Mean);
    ASSERT_EQ(panels.size(), 3u) << "T in both regions, c in one";
    const int regions[] = {formula::kWest, formula::kEast, formula::kWest};
    for (std::size_t p = 0; p < 3; ++p) {
        ASSERT_EQ(panels[p].series.size(), 2u);
        EXPECT_EQ(panels[p].title, volume::labelName(volume::parameterOf(info, channel("region")), regions[p]));
        EXPECT_EQ(panels[p].series[0].name, "0.0 s, 0.7 V");
        EXPECT_EQ(panels[p].series[1].name, "2.0 s, 0.5 V");
        EXPECT_NE(panels[p].series[0].color, panels[p].series[1].color);
        for (std::size_t s = 0; s < 2; ++s)
            for (int z = 0; z < formula::kSize[2]; ++z)
                EXPECT_NEAR(panels[p].series[s].points[std::size_t(z)].y,
                            mean(p < 2 ? "T" : "c", z, s == 0 ? 0 : 2, regions[p]), 1e-4);
    }
    EXPECT_EQ(panels[0].y.range, panels[1].y.range) << "to be compared";
    const std::string csv = csvOf(sectionTable(info, states));
    EXPECT_TRUE(csv.starts_with("time [s],state,z [m],region,")) << csv.substr(0, 60);
    EXPECT_NE(csv.find("\n2,\"2.0 s, 0.5 V\","), std::string::npos);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 2 * 3 * formula::kSize[2]);
    // Alone each is what it was: a line for each region, and no name of a state.
    const std::vector<Plot> alone = sectionPanels(info, {states[1]}, SectionMeasure::Mean);
    ASSERT_EQ(alone.size(), 2u);
    EXPECT_EQ(alone[0].series.size(), 2u);
    EXPECT_EQ(csvOf(sectionTable(info, {states[1]})).find("state"), std::string::npos);
}

TEST_F(StatesOfACell, ASelectionStandsBesideEverything) {
    SectionCurvesQuery brushed = across(1);
    brushed.label = -1;
    brushed.selection.brushes = {vis::rangeBrush({{"region", 0.75, 1.25, 0}})};
    brushed.selection.name = "west";
    SectionCurvesQuery all = brushed;
    all.selection = {};
    const std::vector<SectionCurves> states{readSections(source, brushed), readSections(source, all)};
    const std::vector<Plot> panels = sectionPanels(info, states, SectionMeasure::Mean);
    ASSERT_EQ(panels.size(), 2u);
    ASSERT_EQ(panels[0].series.size(), 2u);
    EXPECT_EQ(panels[0].series[0].name, "west");
    EXPECT_EQ(panels[0].series[1].name, "everything");
    EXPECT_NEAR(panels[0].series[0].points[3].y, mean("T", 3, 1, formula::kWest), 1e-4);
    EXPECT_NE(panels[0].series[0].points[3].y, panels[0].series[1].points[3].y);
}

TEST_F(StatesOfACell, AProfileHasACurveForEachTime) {
    ProfileQuery query;
    query.channels = {channel("T")};
    query.corners = {info.bounds.lo, info.bounds.hi};
    query.samples = 5;
    query.times = chosenTimes(info, {0, 2}, 0);
    const Profile profile = readProfile(*source, query);
    ASSERT_EQ(profile.values[0].size(), 10u);
    const std::vector<Plot> plots = profilePlots(info, {}, profile, false);
    ASSERT_EQ(plots[0].series.size(), 2u);
    EXPECT_EQ(plots[0].series[1].name, "2.0 s, 0.5 V");
    const formula::Place last{formula::kSize[0] - 1, formula::kSize[1] - 1, formula::kSize[2] - 1};
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_NEAR(plots[0].series[s].points.front().y, *formula::value("T", {}, s == 0 ? 0 : 2), 1e-4);
        EXPECT_NEAR(plots[0].series[s].points.back().y, *formula::value("T", last, s == 0 ? 0 : 2), 1e-4);
    }
    const std::string csv = csvOf(profileTable(info, {}, profile));
    EXPECT_TRUE(csv.starts_with("time [s],state,distance [m],")) << csv.substr(0, 60);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 11);
}

TEST_F(StatesOfACell, StatisticsHaveACurveForEachRegion) {
    CurvesView view;
    view.x = "time";
    view.y = {"mean(T)", "mean(c)", "time * 2"};
    view.apart = {"region=1", "region=3", "1"};
    const PlotCurvesQuery query = plotCurvesQuery(view, {}, info);
    ASSERT_EQ(query.regions.size(), 2u) << "each once";
    const volume::Curves curves = readCurves(*source, {}, query);
    ASSERT_EQ(curves.y.size(), 4u) << "c is in the west alone";
    const volume::Parameter& label = volume::parameterOf(info, channel("region"));
    EXPECT_EQ(curves.y[0].name, "mean(T) in " + volume::labelName(label, formula::kWest));
    EXPECT_EQ(curves.y[2].name, "time * 2") << "is of no region";
    EXPECT_EQ(curves.y[3].name, "mean(T) in " + volume::labelName(label, formula::kEast));
    for (int t = 0; t < 3; ++t)
        for (const auto& [curve, region] : {std::pair{0u, formula::kWest}, {3u, formula::kEast}})
            EXPECT_NEAR(curves.y[curve].values[std::size_t(t)],
                        formula::summed("T", formula::kTimes[t],
                                        [&](formula::Place at) { return formula::region(at) == region; })
                            .mean,
                        1e-4);
    EXPECT_EQ(groupTitle(curves, {0, 3}), "mean(T)");
    PlotCurvesQuery against = query;
    against.x = "mean(T)";
    EXPECT_THROW(readCurves(*source, {}, against), Error);
}

TEST(SeveralStates, TwoUnitsShareAPlotWithAnAxisOnEitherSide) {
    volume::Curves curves;
    curves.times = {0, 1, 2};
    curves.x = {"current", "A", {0, 10, 20}};
    curves.y = {{"voltage", "V", {0.9, 0.7, 0.5}}, {"power", "W", {0, 7, 10}}};
    EXPECT_EQ(curvesPlots(curves, 1.0, false).size(), 2u);
    const std::vector<Plot> plots = curvesPlots(curves, 1.0, false, true);
    ASSERT_EQ(plots.size(), 1u);
    const Plot& plot = plots[0];
    ASSERT_TRUE(plot.right);
    EXPECT_EQ(plot.y.unit, "V");
    EXPECT_EQ(plot.right->unit, "W");
    EXPECT_FALSE(plot.series[0].right);
    EXPECT_TRUE(plot.series[1].right);
    EXPECT_EQ(plot.y.ink, plot.series[0].color);
    EXPECT_EQ(plot.right->ink, plot.series[1].color);
    EXPECT_EQ(plot.series[1].points[1].y, 7) << "in its own unit";
    const double share = (7 - plot.right->range.lo) / (plot.right->range.hi - plot.right->range.lo);
    EXPECT_NEAR(plot.marks[1].y, plot.y.range.lo + share * (plot.y.range.hi - plot.y.range.lo), 1e-12);
    const std::string svg = svgOf(curvesDrawing(curves, {}, {}, true));
    for (const char* text : {">voltage [V]</text>", ">power [W]</text>"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    curves.y.push_back({"T", "K", {300, 301, 302}});
    EXPECT_EQ(curvesPlots(curves, {}, false, true).size(), 3u) << "no third axis";
}

TEST(SeveralStates, ADifferenceIsShownWhereItIsNotZero) {
    const volume::DatasetInfo info = operatingPoints();
    const auto timeAfter = [&](double shown, volume::TimeReference from) {
        Session session;
        session.time = shown;
        const bool moved = leaveReference(session, info, from);
        EXPECT_EQ(moved, session.time != shown);
        return session.time;
    };
    using volume::OtherTime;
    EXPECT_EQ(timeAfter(1, {OtherTime::First}), 4);
    EXPECT_EQ(timeAfter(2, {OtherTime::First}), 2);
    EXPECT_EQ(timeAfter(4, {OtherTime::Last}), 1);
    EXPECT_EQ(timeAfter(1, {OtherTime::Previous}), 2);
    EXPECT_EQ(timeAfter(4, {OtherTime::Next}), 1);
    EXPECT_EQ(timeAfter(3, {OtherTime::Time, 3}), 4);
    EXPECT_EQ(timeAfter(3.5, {OtherTime::Time, 3}), 3.5);
}

TEST(SeveralStates, AParameterIsShownInVolumeAndSlices) {
    Session session;
    session.layers = {{"T", false, vis::VolumeLayer{.channel = "T"}},
                      {"T slice", false, vis::SliceLayer{.channel = "T"}}};
    session.layers[0].transfer = "own";
    SlicesView slices;
    slices.channel = "T";
    session.views["slices"] = slices;
    showParameter(session, "T minus first");
    EXPECT_EQ(vis::shownChannel(session.layers[0].technique), "T minus first");
    EXPECT_TRUE(session.layers[0].visible);
    EXPECT_EQ(session.layers[0].name, "T minus first");
    EXPECT_EQ(session.layers[0].transfer, "") << "its own colours";
    EXPECT_EQ(session.layers[1].name, "T minus first slice");
    EXPECT_EQ(std::get<SlicesView>(session.views["slices"]).channel, "T minus first");
    session.layers.clear();
    showParameter(session, "c");
    ASSERT_EQ(session.layers.size(), 1u);
    EXPECT_EQ(vis::shownChannel(session.layers[0].technique), "c");
}

} // namespace
} // namespace tessera::app
