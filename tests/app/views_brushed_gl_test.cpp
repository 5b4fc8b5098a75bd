#include "app/queries/statistics_query.h"
#include "app/views/scatter/scatter_layout.h"
#include "tests/app/views_fixture.h"

#include <cmath>
#include <limits>
#include <thread>

namespace tessera::app {
namespace {

class BrushedViews : public ViewsTest {};

/// Values of two channels at every sample, straight from the bricks.
void forEachSample(const volume::BrickSource& data, int a, int b, int time,
                   const std::function<void(float, float)>& visit) {
    const glm::ivec3 count = data.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const auto read = [&](int channel) { return data.read({channel, time, 0, {x, y, z}}); };
                const volume::BrickSamples first = read(a), second = read(b);
                const auto at = [](const volume::BrickSamples& samples, std::size_t i) {
                    const bool present = samples.present.empty() || samples.present[i];
                    return present ? samples.values[i] : std::numeric_limits<float>::quiet_NaN();
                };
                for (std::size_t i = 0; i < first.values.size(); ++i) visit(at(first, i), at(second, i));
            }
}

// Or the end of the first stroke would be read in another place than its beginning.
TEST_F(BrushedViews, PlotsStayWhereTheyAreWhenBrushesComeAndGo) {
    show(fuelCell(volume::LatticeKind::BCC));
    for (float width = 900; width >= 250; width -= 37) {
        const auto matrix = [&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {width, 700}); };
        const auto layout = [&] {
            for (int i = 0; i < 3; ++i) frame(matrix);
            return dynamic_cast<const ScatterLayoutCache&>(*caches.at("scatterMatrix")).layout;
        };
        session.selection.brushes.clear();
        const ScatterLayout without = layout();
        vis::Brush brush;
        brush.region = vis::RangeRegion{{{"T", 0, 1e9}}};
        session.selection.brushes = {brush};
        const ScatterLayout with = layout();
        EXPECT_EQ(with.min.y, without.min.y) << width;
        EXPECT_EQ(with.cellY, without.cellY) << width;
    }
}

// The promise of the program: brush the hot, oxygen-poor points with the mouse, and exactly those are selected.
TEST_F(BrushedViews, BrushingHotAndOxygenPoorSelectsWhatBruteForceSelects) {
    show(fuelCell(volume::LatticeKind::BCC));
    session.time = source->info().times.back();
    scatterView.softness = 0;
    const auto matrix = [&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {900, 700}); };
    frame(matrix);
    frame(matrix);
    const auto* cache = dynamic_cast<const ScatterLayoutCache*>(caches.at("scatterMatrix").get());
    ASSERT_NE(cache, nullptr);
    const ScatterLayout layout = cache->layout;
    std::size_t oxygen = 99, heat = 99;
    for (std::size_t i = 0; i < layout.size(); ++i) {
        if (layout.infos[i].name == "O2") oxygen = i;
        if (layout.infos[i].name == "T") heat = i;
    }
    ASSERT_LT(oxygen, heat);
    const PlotFrame plot = layout.cell(oxygen, heat);
    // Medians of the samples that have both: about a quarter or so will be hot and poor.
    const int o2 = layout.channels[oxygen], t = layout.channels[heat];
    const int time = source->info().nearestTime(session.time);
    std::vector<float> allO2, allT;
    forEachSample(*source, o2, t, time, [&](float a, float b) {
        if (std::isnan(a) || std::isnan(b)) return;
        allO2.push_back(a);
        allT.push_back(b);
    });
    ASSERT_GT(allO2.size(), 20u);
    std::nth_element(allO2.begin(), allO2.begin() + static_cast<std::ptrdiff_t>(allO2.size() / 2), allO2.end());
    std::nth_element(allT.begin(), allT.begin() + static_cast<std::ptrdiff_t>(allT.size() / 4), allT.end());
    const double poor = static_cast<double>(allO2[allO2.size() / 2]), hot = static_cast<double>(allT[allT.size() / 4]);

    const ImVec2 from = plot.pixel(poor, hot), to{plot.min.x - 20, plot.min.y - 20};
    mouse = from;
    frame(matrix);
    ImGui::GetIO().MouseDown[0] = true;
    frame(matrix);
    for (float share : {0.3f, 0.7f, 1.0f}) {
        mouse = {from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
        frame(matrix);
    }
    ImGui::GetIO().MouseDown[0] = false;
    frame(matrix);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    const auto& brush = std::get<vis::RangeRegion>(session.selection.brushes[0].region);
    ASSERT_EQ(brush.intervals.size(), 2u);
    EXPECT_EQ(brush.intervals[0].channel, "O2");
    EXPECT_EQ(brush.intervals[1].channel, "T");
    EXPECT_NEAR(brush.intervals[0].hi, poor, plot.perPixelX());
    EXPECT_NEAR(brush.intervals[1].lo, hot, plot.perPixelY());
    EXPECT_EQ(brush.intervals[1].hi, plot.y.hi) << "dragged beyond the plot, it ends at its edge";

    std::uint64_t expected = 0, total = 0;
    double hottest = 0;
    forEachSample(*source, o2, t, time, [&](float a, float b) {
        total += !std::isnan(b);
        const double x = static_cast<double>(a), y = static_cast<double>(b);
        const bool in = x >= brush.intervals[0].lo && x <= brush.intervals[0].hi && y >= brush.intervals[1].lo &&
                        y <= brush.intervals[1].hi;
        expected += in;
        if (in) hottest = std::max(hottest, y);
    });
    EXPECT_GT(expected, 0u);
    EXPECT_LT(expected, total);
    ViewContext context{session, source, renderer, jobs, caches};
    context.headless = true;
    AsyncStatistics answers;
    const auto result =
        answers.get(context, "test", brushedQuery(session, source->info(), {o2, t}, {plot.x, plot.y}, 32, true));
    ASSERT_NE(result, nullptr);
    EXPECT_TRUE(result->brushed);
    EXPECT_EQ(result->statistics.channels[0].inside.samples, static_cast<double>(expected));
    EXPECT_EQ(result->statistics.channels[1].inside.samples, static_cast<double>(expected));
    EXPECT_EQ(result->statistics.channels[1].inside.max, hottest);
    double focus = 0;
    for (double f : result->statistics.joint[0].focus) focus += f;
    EXPECT_NEAR(focus, static_cast<double>(expected), 1e-3);
}

// A click enlarges a plot; a drag in the large one brushes by its own pixels, not by those of the small one.
TEST_F(BrushedViews, AClickEnlargesAPlotThatCanBeBrushed) {
    show(fuelCell(volume::LatticeKind::BCC));
    const auto matrix = [&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {900, 700}); };
    const auto button = [&](bool down) {
        ImGui::GetIO().MouseDown[0] = down;
        frame(matrix);
    };
    frame(matrix);
    frame(matrix);
    const ScatterLayout layout = dynamic_cast<const ScatterLayoutCache*>(caches.at("scatterMatrix").get())->layout;
    ASSERT_GE(layout.size(), 4u);
    const PlotFrame small = layout.cell(0, 2);
    mouse = {(small.min.x + small.max.x) / 2, (small.min.y + small.max.y) / 2};
    frame(matrix);
    button(true);
    button(false);
    const std::vector<std::string> wanted{layout.infos[0].name, layout.infos[2].name};
    EXPECT_EQ(scatterView.enlarged, wanted);
    EXPECT_TRUE(session.selection.brushes.empty());

    const PlotFrame corner = layout.cell(layout.size() - 1, 0);
    mouse = {corner.max.x - 10, corner.min.y + 10};
    frame(matrix);
    button(true);
    mouse = {corner.max.x - 60, corner.min.y + 40};
    frame(matrix);
    button(false);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    const vis::BrushInterval& x = std::get<vis::RangeRegion>(session.selection.brushes[0].region).intervals[0];
    EXPECT_EQ(x.channel, wanted[0]);
    // 50 pixels of a plot more than two cells wide.
    EXPECT_LT(x.hi - x.lo, 50 * small.perPixelX());
    EXPECT_GT(x.hi - x.lo, 10 * small.perPixelX());

    mouse = {small.max.x - 3, small.max.y - 3};
    frame(matrix);
    button(true);
    button(false);
    EXPECT_TRUE(scatterView.enlarged.empty()) << "another click puts it away";
}

// A selection with a channel that is not shown, soft edges and an inverted brush: the answers's compiled function of
// the values agrees with the definition.
TEST_F(BrushedViews, FeedCountsWhatTheSelectionDefines) {
    show(fuelCell(volume::LatticeKind::CC));
    const volume::DatasetInfo& info = source->info();
    const auto channelOf = [&](const char* name) { return *info.findChannel(name); };
    const Range heat = info.channelRange(info.channel(channelOf("T")));
    const Range water = info.channelRange(info.channel(channelOf("H2O")));
    const double width = water.hi - water.lo;
    session.selection.brushes = {
        vis::rangeBrush({{"H2O", water.lo, water.lo + width * 0.4, width * 0.2}}, "water"),
        vis::rangeBrush({{"T", heat.lo, (heat.lo + heat.hi) / 2, 0}}, "heat"),
        vis::rangeBrush({{"T", 0, 1, 0}}, "off"),
    };
    session.selection.brushes[1].inverted = true;
    session.selection.brushes[2].enabled = false;
    for (const vis::BrushCombine combine : {vis::BrushCombine::And, vis::BrushCombine::Or, vis::BrushCombine::Minus}) {
        session.selection.brushes[1].combine = combine;
        ViewContext context{session, source, renderer, jobs, caches};
        context.headless = true;
        AsyncStatistics answers;
        const auto result =
            answers.get(context, "test", brushedQuery(session, info, {channelOf("p")}, {{0, 2e5}}, 8, false));
        ASSERT_NE(result, nullptr);
        double expected = 0;
        std::vector<std::pair<float, float>> values;
        forEachSample(*source, channelOf("H2O"), channelOf("T"), 0, [&](float a, float b) {
            values.push_back({a, b});
        });
        std::size_t i = 0;
        forEachSample(*source, channelOf("p"), channelOf("p"), 0, [&](float p, float) {
            const auto [h2o, t] = values[i++];
            if (std::isnan(p)) return;
            const double doi = vis::degreeOfInterest(
                session.selection, [&](const std::string& name) { return static_cast<double>(name == "T" ? t : h2o); });
            expected += doi;
        });
        double focus = 0;
        for (double f : result->statistics.channels[0].histogram.focus) focus += f;
        EXPECT_NEAR(focus, expected, 1e-3 * (1 + expected));
        EXPECT_NEAR(result->statistics.channels[0].inside.samples, expected, 1e-3 * (1 + expected));
    }
}

} // namespace
} // namespace tessera::app
