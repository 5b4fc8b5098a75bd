#include "app/views/parallel/parallel_plot.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/table_text.h"

/// The mouse in parallel coordinates: brushes on axes and between them, titles that are dragged, zoom, menus.
namespace tessera::app {
namespace {

class ParallelHands : public Hands {
protected:
    void showAxes(const std::function<void(ParallelCoordinatesView&)>& change = {},
                  const std::function<void(Session&)>& prepare = {}, glm::ivec2 size = {560, 420}) {
        ParallelCoordinatesView parallel;
        parallel.channels = {"T", "c", "|U|"};
        parallel.bins = 16;
        parallel.softness = 0;
        if (change) change(parallel);
        show(parallel, size, prepare);
        ASSERT_EQ(plot().axes.size(), parallel.channels.size());
    }
    const ParallelPlot& plot(std::size_t index = 0) {
        const auto* cache = dynamic_cast<const ParallelLayoutCache*>(workbench.cache("pane"));
        return cache->plots.at(index);
    }
    ParallelCoordinatesView& parallel() { return view<ParallelCoordinatesView>(); }
    /// A pixel on an axis, at a share of its height from below.
    ImVec2 onAxis(std::size_t axis, double up) {
        const ParallelAxis& own = plot().axes[axis];
        return {std::floor(own.x), std::floor(float(double(own.bottom) - up * double(own.bottom - own.top)))};
    }
    /// What an axis shows at a pixel, from its range alone.
    double shownAt(ImVec2 at, std::size_t axis, Range shown) {
        const ParallelAxis& own = plot().axes[axis];
        return shown.lo + double((own.bottom - at.y) / (own.bottom - own.top)) * (shown.hi - shown.lo);
    }
    static Range whole(const char* channel) {
        const Range range = formula::rangeOf(channel);
        const double margin = 0.02 * (range.hi - range.lo);
        return {range.lo - margin, range.hi + margin};
    }
    vis::BrushInterval interval() {
        const auto& brushes = session().selection.brushes;
        if (brushes.size() != 1 || !std::holds_alternative<vis::RangeRegion>(brushes[0].region)) {
            ADD_FAILURE() << brushes.size() << " brushes";
            return {};
        }
        return std::get<vis::RangeRegion>(brushes[0].region).intervals.at(0);
    }
    /// Samples in the selection, of those with a value on the first two axes or one of them, as exported.
    double selectedSamples() {
        const ViewExport* offered = workbench.exported("pane");
        if (!offered || !offered->table) return -1;
        const TableText table = tableOf(csvOf(offered->table({})));
        double sum = 0;
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            if (table.text(row, "left parameter") == parallel().channels.front())
                sum += std::stod(table.rows[row].back());
        return sum;
    }
    static double counted(const char* channel, double lo, double hi) {
        double sum = 0;
        formula::forEachPlace([&](formula::Place at) {
            const auto v = formula::value(channel, at, 1);
            sum += v && double(*v) >= lo && double(*v) <= hi ? 1 : 0;
        });
        return sum;
    }
};

TEST_F(ParallelHands, ADragOnAnAxisSelectsItsValues) {
    showAxes();
    const Session before = session();
    const ImVec2 from = onAxis(0, 0.7), to = onAxis(0, 0.3);
    drag(from, to);
    EXPECT_EQ(interval().channel, "T");
    EXPECT_NEAR(interval().lo, shownAt(to, 0, whole("T")), 1e-6);
    EXPECT_NEAR(interval().hi, shownAt(from, 0, whole("T")), 1e-6);
    settle();
    EXPECT_EQ(steps(), 1u);
    const double expected = counted("T", interval().lo, interval().hi);
    EXPECT_GT(expected, 20);
    EXPECT_EQ(selectedSamples(), expected) << "of all samples";
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    drag(onAxis(1, 0.2), onAxis(1, 0.8));
    settle();
    EXPECT_EQ(interval().channel, "c");
    EXPECT_EQ(selectedSamples(), counted("c", interval().lo, interval().hi)) << "absent samples are never selected";
}

TEST_F(ParallelHands, ABrushIsMovedResizedTakenBackAndRemoved) {
    showAxes();
    drag(onAxis(2, 0.4), onAxis(2, 0.6));
    const vis::BrushInterval made = interval();
    EXPECT_EQ(made.channel, "|U|");
    drag(onAxis(2, 0.6), onAxis(2, 0.8)); // its upper edge
    EXPECT_EQ(interval().lo, made.lo);
    EXPECT_NEAR(interval().hi, shownAt(onAxis(2, 0.8), 2, whole("|U|")), 1e-3);
    const vis::BrushInterval grown = interval();
    const ImVec2 held = onAxis(2, 0.6);
    drag(held, {held.x, held.y + 20}); // as a whole, down
    const double moved = shownAt(held, 2, whole("|U|")) - shownAt({held.x, held.y + 20}, 2, whole("|U|"));
    EXPECT_NEAR(interval().lo, grown.lo - moved, 1e-5);
    EXPECT_NEAR(interval().hi, grown.hi - moved, 1e-5);
    const vis::Selection now = session().selection;
    moveTo(onAxis(2, 0.5));
    button(0, true);
    moveTo(onAxis(2, 0.55));
    EXPECT_FALSE(session().selection == now);
    press(key::kEscape);
    button(0, false);
    EXPECT_TRUE(session().selection == now) << "Esc takes the drag back";
    shift = true;
    drag(onAxis(0, 0.1), onAxis(0, 0.3));
    shift = false;
    ASSERT_EQ(session().selection.brushes.size(), 2u);
    EXPECT_EQ(session().selection.brushes[1].combine, vis::BrushCombine::Or);
    click(onAxis(2, 0.5), 1);
    EXPECT_EQ(interval().channel, "T") << "the right button removes the one under the mouse";
}

TEST_F(ParallelHands, FlippedAndLogarithmicAxesHaveTheirOwnValues) {
    showAxes([](ParallelCoordinatesView& view) {
        view.flipped = {"T"};
        view.logarithmic = {"c"};
    });
    const ImVec2 low = onAxis(0, 0.3), high = onAxis(0, 0.7);
    drag(low, high);
    const auto mirrored = [&](ImVec2 at) { return whole("T").lo + whole("T").hi - shownAt(at, 0, whole("T")); };
    EXPECT_NEAR(interval().lo, mirrored(high), 1e-6);
    EXPECT_NEAR(interval().hi, mirrored(low), 1e-6);
    settle();
    EXPECT_EQ(selectedSamples(), counted("T", interval().lo, interval().hi));
    const vis::BrushInterval made = interval();
    drag(high, onAxis(0, 0.9)); // the edge at the top is the lower value
    EXPECT_EQ(interval().hi, made.hi);
    EXPECT_LT(interval().lo, made.lo);
    session().selection.brushes.clear();
    frame();
    const ImVec2 from = onAxis(1, 0.25), to = onAxis(1, 0.75);
    drag(from, to);
    const Range range = formula::rangeOf("c");
    const double margin = std::pow(range.hi / range.lo, 0.02);
    const Range logs{std::log(range.lo / margin), std::log(range.hi * margin)};
    EXPECT_NEAR(interval().lo, std::exp(shownAt(from, 1, logs)), 1e-5);
    EXPECT_NEAR(interval().hi, std::exp(shownAt(to, 1, logs)), 1e-5);
    settle();
    EXPECT_EQ(selectedSamples(), counted("c", interval().lo, interval().hi));
}

TEST_F(ParallelHands, ADragBetweenAxesSelectsTheLinesThere) {
    showAxes();
    const ParallelAxis left = plot().axes[0], right = plot().axes[1];
    const float x = std::floor((left.x + right.x) / 2);
    const ImVec2 from{x, onAxis(0, 0.35).y}, to{x, onAxis(0, 0.2).y};
    drag(from, to);
    settle();
    ASSERT_EQ(session().selection.brushes.size(), 1u);
    const auto& lasso = std::get<vis::LassoRegion>(session().selection.brushes[0].region);
    EXPECT_EQ(lasso.x, "T");
    EXPECT_EQ(lasso.y, "c");
    double surely = 0, perhaps = 0; // the edge of a polygon is drawn with a table
    formula::forEachPlace([&](formula::Place at) {
        const auto c = formula::value("c", at, 1);
        if (!c) return;
        const double y = double(left.pixel(*formula::value("T", at, 1))) * 0.5 + double(right.pixel(*c)) * 0.5;
        surely += y > double(from.y) + 6 && y < double(to.y) - 6;
        perhaps += y > double(from.y) - 6 && y < double(to.y) + 6;
    });
    EXPECT_GT(surely, 10);
    EXPECT_GE(selectedSamples(), surely - 1);
    EXPECT_LE(selectedSamples(), perhaps + 1);
    EXPECT_LT(perhaps, 200) << "not everything";
    EXPECT_EQ(steps(), 1u);
}

TEST_F(ParallelHands, AStrokeThatRisesFurtherThanTheAxesKeepsWhatWasSelected) {
    showAxes([](ParallelCoordinatesView& view) { view.channels = {"T", "|U|"}; }, {}, {900, 260});
    const ParallelAxis left = plot().axes[0], right = plot().axes[1];
    const float gap = right.x - left.x, height = left.bottom - left.top;
    ASSERT_GT(gap, 2 * height);
    const ImVec2 from{std::floor(left.x + gap / 2), std::floor(left.bottom - height * 0.2f)};
    moveTo(from);
    button(0, true);
    moveTo({from.x + 60, from.y - 4});
    ASSERT_EQ(session().selection.brushes.size(), 1u);
    const vis::Selection flat = session().selection;
    EXPECT_GT(std::get<vis::LassoRegion>(flat.brushes[0].region).points.size(), 2u);
    moveTo({from.x + 60, from.y - 58}); // no line between these axes rises like this
    EXPECT_TRUE(session().selection == flat);
    button(0, false);
    settle();
    EXPECT_TRUE(session().selection == flat);
}

TEST_F(ParallelHands, ATitleIsDraggedToAnotherPlace) {
    showAxes();
    const Session before = session();
    const ImRect title = inPane({0, 0, "title"});
    drag(title.GetCenter(), {plot().axes[2].x, title.GetCenter().y});
    EXPECT_EQ(parallel().channels, (std::vector<std::string>{"c", "|U|", "T"}));
    settle();
    EXPECT_EQ(steps(), 1u);
    const std::size_t brushes = session().selection.brushes.size();
    EXPECT_EQ(brushes, 0u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(ParallelHands, ATitleHasAMenu) {
    showAxes();
    click(inPane({0, 1, "title"}).GetCenter());
    ASSERT_NE(popup(), nullptr);
    click(item(popup(), {"Flip"}).GetCenter());
    EXPECT_EQ(parallel().flipped, std::vector<std::string>{"c"});
    click(inPane({0, 1, "title"}).GetCenter(), 1);
    ASSERT_NE(popup(), nullptr);
    click(item(popup(), {"Logarithmic"}).GetCenter());
    EXPECT_EQ(parallel().logarithmic, std::vector<std::string>{"c"});
    EXPECT_TRUE(plot().axes[1].density.logarithmic);
    click(inPane({0, 1, "title"}).GetCenter());
    ASSERT_NE(popup(), nullptr);
    click(item(popup(), {"Remove axis"}).GetCenter());
    EXPECT_EQ(parallel().channels, (std::vector<std::string>{"T", "|U|"}));
}

TEST_F(ParallelHands, TheWheelZoomsAnAxisAboutTheMouse) {
    showAxes();
    moveTo(onAxis(0, 0.3));
    const Range all = whole("T");
    const double about = shownAt(mouse, 0, all);
    turnWheel(2);
    const double factor = 0.85 * 0.85;
    ASSERT_TRUE(parallel().zoom.contains("T"));
    EXPECT_NEAR(parallel().zoom["T"].lo, about + (all.lo - about) * factor, 1e-6);
    EXPECT_NEAR(parallel().zoom["T"].hi, about + (all.hi - about) * factor, 1e-6);
    EXPECT_EQ(parallel().zoom.size(), 1u);
    settle();
    EXPECT_NEAR(shownAt(mouse, 0, parallel().zoom["T"]), about, 1e-6) << "what is under the mouse stays there";
    EXPECT_EQ(plot().axes[0].density.range, parallel().zoom["T"]);
    const Range near = parallel().zoom["T"];
    button(2, true);
    moveTo({mouse.x, mouse.y - 10});
    button(2, false);
    EXPECT_NEAR(shownAt(mouse, 0, parallel().zoom["T"]), shownAt({mouse.x, mouse.y + 10}, 0, near), 1e-5);
    settle();
    ImGui::GetIO().MouseDoubleClickTime = 0.3f;
    for (int i = 0; i < 2; ++i) click(onAxis(0, 0.5), 2);
    EXPECT_TRUE(parallel().zoom.empty());
}

TEST_F(ParallelHands, EveryTimeHasAPlot) {
    showAxes([](ParallelCoordinatesView& view) { view.times = {0, 2}; });
    EXPECT_LT(plot(0).axes[0].bottom, plot(1).axes[0].top);
    drag(onAxis(0, 0.2), onAxis(0, 0.8)); // in the first
    settle();
    double expected = 0;
    for (const int time : {0, 2})
        formula::forEachPlace([&](formula::Place at) {
            const double v = *formula::value("T", at, time);
            expected += v >= interval().lo && v <= interval().hi ? 1 : 0;
        });
    EXPECT_EQ(selectedSamples(), expected) << "of both times";
}

TEST_F(ParallelHands, AxesStandInTheOrderOfTheirCorrelations) {
    showAxes([](ParallelCoordinatesView& view) {
        view.channels = {"T", "|U|", "U.z", "U.x"};
        view.byCorrelation = true;
    });
    std::vector<std::string> names;
    for (const ParallelAxis& axis : plot().axes) names.push_back(axis.channel.name);
    std::vector<std::string> each = parallel().channels, best;
    std::ranges::sort(each);
    const auto correlation = [](const std::string& a, const std::string& b) {
        double n = 0, sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
        formula::forEachPlace([&](formula::Place at) {
            const double u = *formula::value(a, at, 1) - (a == "T" ? 300.0 : 0),
                         v = *formula::value(b, at, 1) - (b == "T" ? 300.0 : 0);
            const double w = formula::cellShare(at);
            n += w, sa += w * u, sb += w * v, aa += w * u * u, bb += w * v * v, ab += w * u * v;
        });
        return std::abs((n * ab - sa * sb) / std::sqrt((n * aa - sa * sa) * (n * bb - sb * sb)));
    };
    const auto chained = [&](const std::vector<std::string>& order) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < order.size(); ++i) sum += correlation(order[i], order[i + 1]);
        return sum;
    };
    double most = 0;
    do most = std::max(most, chained(each));
    while (std::next_permutation(each.begin(), each.end()));
    EXPECT_NEAR(chained(names), most, 1e-4);
    EXPECT_LT(chained(parallel().channels), most - 0.01) << "another order than the one named";
}

} // namespace
} // namespace tessera::app
