#include "app/views/scatter/scatter_layout.h"
#include "tests/app/hands_fixture.h"

/// The mouse in plots of values: zoom and pan of scatterplots, brushes of a histogram, transfer functions.
namespace tessera::app {
namespace {

/// A range with some of its width more on both sides.
Range withMargin(Range range, double share) {
    const double more = (range.hi - range.lo) * share;
    return {range.lo - more, range.hi + more};
}

class ScatterHands : public Hands {
protected:
    void showPlots(const std::function<void(Session&)>& prepare = {}) {
        ScatterMatrixView scatter;
        scatter.channels = {"T", "|U|", "c"};
        scatter.bins = 16;
        show(scatter, {520, 460}, prepare);
        const std::vector<ImRect> drawn = pictures(); // T-|U|, T-c, |U|-c: a column is one parameter
        ASSERT_EQ(drawn.size(), 3u);
        plot = drawn[0];
    }
    std::map<std::string, Range>& zoom() { return view<ScatterMatrixView>().zoom; }
    static Range whole(const char* channel) { return withMargin(formula::rangeOf(channel), 0.02); }
    /// What the plot of T and |U| shows at a pixel.
    glm::dvec2 shownAt(ImVec2 at) {
        const auto shown = [&](const char* channel) {
            return zoom().contains(channel) ? zoom()[channel] : whole(channel);
        };
        return {across(plot, shown("T"), at), upwards(plot, shown("|U|"), at)};
    }
    void expectRange(const char* channel, Range expected) {
        ASSERT_TRUE(zoom().contains(channel)) << channel;
        const double exact = (expected.hi - expected.lo) * 1e-9;
        EXPECT_NEAR(zoom()[channel].lo, expected.lo, exact) << channel;
        EXPECT_NEAR(zoom()[channel].hi, expected.hi, exact) << channel;
    }
    static double width(Range range) { return range.hi - range.lo; }
    ImRect plot;
};

TEST_F(ScatterHands, TheWheelZoomsAboutTheMouse) {
    showPlots();
    const Session before = session();
    moveTo(within(plot, 0.3, 0.6));
    const glm::dvec2 about = shownAt(mouse);
    const auto nearer = [](Range range, double at, double factor) {
        return Range{at + (range.lo - at) * factor, at + (range.hi - at) * factor};
    };
    turnWheel(2);
    const double factor = 0.85 * 0.85;
    expectRange("T", nearer(whole("T"), about.x, factor));
    expectRange("|U|", nearer(whole("|U|"), about.y, factor));
    EXPECT_FALSE(zoom().contains("c"));
    EXPECT_NEAR(shownAt(mouse).x, about.x, 1e-9 * std::abs(about.x)) << "what is under the mouse stays there";
    EXPECT_NEAR(shownAt(mouse).y, about.y, 1e-9 * std::abs(about.y));
    frame();
    EXPECT_EQ(steps(), 1u);
    turnWheel(-1);
    expectRange("T", nearer(whole("T"), about.x, 0.85));
    turnWheel(-3);
    EXPECT_TRUE(zoom().empty()) << "no farther than all";
    settle();
    EXPECT_TRUE(session() == before) << apart(before);
    // Away from one end and back at the other: it keeps to what there is.
    moveTo(within(plot, 0.02, 0.98));
    turnWheel(3);
    moveTo(within(plot, 0.98, 0.02));
    turnWheel(-1);
    for (const char* channel : {"T", "|U|"}) {
        EXPECT_DOUBLE_EQ(zoom()[channel].lo, whole(channel).lo);
        EXPECT_NEAR(width(zoom()[channel]), width(whole(channel)) * factor, width(whole(channel)) * 1e-9);
    }
}

TEST_F(ScatterHands, TheMiddleButtonPansAndItsDoubleClickShowsAll) {
    const auto middle = [](const char* channel) { return withMargin(whole(channel), -0.3); };
    showPlots([&](Session& edited) {
        auto& scatter = std::get<ScatterMatrixView>(edited.views.at("pane"));
        scatter.zoom = {{"T", middle("T")}, {"|U|", middle("|U|")}};
    });
    const Session before = session();
    moveTo(within(plot, 0.4, 0.5));
    const glm::dvec2 held = shownAt(mouse);
    button(2, true);
    for (const ImVec2 by : {ImVec2{9, 6}, ImVec2{-4, 5}}) {
        moveTo({mouse.x + by.x, mouse.y + by.y});
        EXPECT_NEAR(shownAt(mouse).x, held.x, 1e-8 * std::abs(held.x)) << "the plot goes with the mouse";
        EXPECT_NEAR(shownAt(mouse).y, held.y, 1e-8 * std::abs(held.y));
    }
    EXPECT_DOUBLE_EQ(width(zoom()["T"]), width(middle("T")));
    button(2, false);
    frame();
    EXPECT_EQ(steps(), 1u);
    EXPECT_TRUE(session().selection == before.selection);
    for (int i = 0; i < 6; ++i) drag(within(plot, 0.1, 0.9), within(plot, 0.9, 0.1), 2);
    for (const char* channel : {"T", "|U|"}) {
        EXPECT_DOUBLE_EQ(zoom()[channel].lo, whole(channel).lo) << "to the right and up: the least values";
        EXPECT_NEAR(width(zoom()[channel]), width(middle(channel)), width(middle(channel)) * 1e-9);
    }
    ImGui::GetIO().MouseDoubleClickTime = 0.3f;
    for (int i = 0; i < 2; ++i) click(within(plot, 0.5, 0.5), 2);
    EXPECT_TRUE(zoom().empty());
}

TEST_F(ScatterHands, AHistogramZoomsItsOwnParameter) {
    showPlots();
    const auto* cache = dynamic_cast<const ScatterLayoutCache*>(workbench.cache("pane"));
    const PlotFrame histogram = cache->layout.cell(1, 1);
    moveTo({(histogram.min.x + histogram.max.x) / 2, (histogram.min.y + histogram.max.y) / 2});
    turnWheel(1);
    ASSERT_EQ(zoom().size(), 1u);
    EXPECT_NEAR(width(zoom()["|U|"]), 0.85 * width(whole("|U|")), 1e-9);
    const Session before = session();
    const PlotFrame correlation = cache->layout.cell(1, 0);
    moveTo({(correlation.min.x + correlation.max.x) / 2, (correlation.min.y + correlation.max.y) / 2});
    turnWheel(1);
    EXPECT_TRUE(session() == before) << "a correlation has nothing to zoom";
}

TEST_F(ScatterHands, ADragIsABrushAndOneStep) {
    showPlots([](Session& edited) { std::get<ScatterMatrixView>(edited.views.at("pane")).softness = 0; });
    const Session before = session();
    const ImVec2 from = within(plot, 0.7, 0.2), to = within(plot, 0.25, 0.6); // leftwards and down
    drag(from, to);
    ASSERT_EQ(session().selection.brushes.size(), 1u);
    const auto intervals = std::get<vis::RangeRegion>(session().selection.brushes[0].region).intervals;
    ASSERT_EQ(intervals.size(), 2u);
    EXPECT_EQ(intervals[0].channel, "T");
    EXPECT_EQ(intervals[1].channel, "|U|");
    const double exact = 1e-9 * 400;
    EXPECT_NEAR(intervals[0].lo, shownAt(to).x, exact);
    EXPECT_NEAR(intervals[0].hi, shownAt(from).x, exact);
    EXPECT_NEAR(intervals[1].lo, shownAt(to).y, exact);
    EXPECT_NEAR(intervals[1].hi, shownAt(from).y, exact);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

// The command of Esc is run after the frame; in a picture without a window its question is answered with yes.
TEST_F(ScatterHands, ARightClickBesideSeveralBrushesIsLeftToTheCommandThatAsks) {
    showPlots([](Session& edited) { edited.selection.brushes.resize(2); });
    moveTo(within(plot, 0.5, 0.5));
    button(1, true);
    button(1, false);
    EXPECT_EQ(session().selection.brushes.size(), 2u) << "the plot itself clears nothing";
    frame();
    EXPECT_TRUE(session().selection.brushes.empty());
}

class HistogramHands : public Hands {};

TEST_F(HistogramHands, ARightClickBesideSeveralBrushesIsLeftToTheCommandThatAsks) {
    HistogramView histogram;
    histogram.channel = "T";
    show(histogram, {500, 300}, [](Session& edited) { edited.selection.brushes.resize(2); });
    moveTo(within(inPane({"plot"}), 0.5, 0.5));
    button(1, true);
    button(1, false);
    EXPECT_EQ(session().selection.brushes.size(), 2u);
    frame();
    EXPECT_TRUE(session().selection.brushes.empty());
}

TEST_F(HistogramHands, ADragSelectsTheValuesBelowIt) {
    HistogramView histogram;
    histogram.channel = "T";
    histogram.softness = 0;
    show(histogram, {500, 300});
    const ImRect plot = inPane({"plot"});
    const Range shown = withMargin(formula::rangeOf("T"), 0.02);
    const double pixel = (shown.hi - shown.lo) / plot.GetWidth();
    const Session before = session();
    const auto interval = [&] {
        return std::get<vis::RangeRegion>(session().selection.brushes.at(0).region).intervals.at(0);
    };
    drag(within(plot, 0.6, 0.2), within(plot, 0.3, 0.7));
    ASSERT_EQ(session().selection.brushes.size(), 1u);
    EXPECT_EQ(interval().channel, "T");
    EXPECT_NEAR(interval().lo, across(plot, shown, within(plot, 0.3, 0)), pixel * 1e-3);
    EXPECT_NEAR(interval().hi, across(plot, shown, within(plot, 0.6, 0)), pixel * 1e-3);
    settle();
    EXPECT_EQ(steps(), 1u);
    const vis::BrushInterval made = interval();
    drag(within(plot, 0.6, 0.5), within(plot, 0.8, 0.5)); // its right edge
    EXPECT_EQ(interval().lo, made.lo);
    EXPECT_NEAR(interval().hi, made.hi + pixel * (within(plot, 0.8, 0).x - within(plot, 0.6, 0).x), pixel * 1e-3);
    drag(within(plot, 0.5, 0.5), {plot.Max.x + 200, plot.GetCenter().y}); // the whole, up to the end
    EXPECT_NEAR(interval().hi, shown.hi, pixel * 1e-3);
    const vis::Selection moved = session().selection;
    moveTo(within(plot, 0.8, 0.5));
    button(0, true);
    moveTo(within(plot, 0.6, 0.5));
    EXPECT_FALSE(session().selection == moved);
    press(key::kEscape);
    button(0, false);
    EXPECT_TRUE(session().selection == moved) << "Esc takes the drag back";
    click(within(plot, 0.8, 0.5), 1);
    EXPECT_TRUE(session().selection.brushes.empty()) << "the right button removes it";
}

class TransferHands : public Hands {
protected:
    void showTransfer() {
        TransferView transfer;
        transfer.channel = "T";
        show(transfer, {520, 320}, [](Session& edited) {
            edited.transfer["T"].opacity = {{0, 0}, {1, 0.8f}};
            edited.transfer["T"].autoRange = true;
        });
        curve = inPane({"curve"});
        strip = inPane({"strip"});
    }
    vis::TransferFunction& function() { return session().transfer.at("T"); }
    /// Opacity point at a pixel, of the data's own range.
    glm::vec2 pointAt(ImVec2 at) const {
        return {float((across(curve, shown, at) - data.lo) / (data.hi - data.lo)), float(upwards(curve, {0, 1}, at))};
    }
    float pixelOf(double value) const {
        return float(curve.Min.x + (value - shown.lo) / (shown.hi - shown.lo) * curve.GetWidth());
    }
    void expectPoint(std::size_t index, glm::vec2 expected) {
        ASSERT_LT(index, function().opacity.size());
        EXPECT_NEAR(function().opacity[index].x, expected.x, 1e-5f);
        EXPECT_NEAR(function().opacity[index].y, expected.y, 1e-5f);
    }
    Range data = formula::rangeOf("T"), shown = withMargin(data, 0.03);
    ImRect curve, strip;
};

TEST_F(TransferHands, OpacityPointsAreAddedDraggedAndRemoved) {
    showTransfer();
    const Session before = session();
    moveTo(within(curve, 0.4, 0.25));
    const glm::vec2 added = pointAt(mouse);
    button(0, true);
    ASSERT_EQ(function().opacity.size(), 3u);
    expectPoint(1, added);
    moveTo(within(curve, 0.7, 0.6));
    expectPoint(1, pointAt(mouse));
    moveTo({curve.Max.x + 50, curve.Min.y - 50});
    expectPoint(1, {1, 1}); // no farther than the next one and full opacity
    moveTo({curve.Min.x - 50, curve.Max.y + 50});
    expectPoint(1, {0, 0});
    moveTo(within(curve, 0.5, 0.5));
    button(0, false);
    expectPoint(1, pointAt(mouse));
    expectPoint(0, {0, 0});
    expectPoint(2, {1, 0.8f});
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    click(within(curve, 0.3, 0.3));
    const glm::vec2 first = function().opacity.at(1);
    drag(within(curve, 0.6, 0.5), {curve.Min.x - 50, curve.GetCenter().y});
    EXPECT_EQ(function().opacity.at(1), first);
    EXPECT_EQ(function().opacity.at(2).x, first.x) << "a point never passes its neighbour";
    function().opacity = before.transfer.at("T").opacity;
    // The ends can be lifted and drawn in.
    drag({pixelOf(data.hi), curve.Min.y + 0.2f * curve.GetHeight()}, within(curve, 0.8, 0.9));
    ASSERT_EQ(function().opacity.size(), 2u);
    EXPECT_NEAR(function().opacity[1].x, pointAt(mouse).x, 1e-5f);
    EXPECT_NEAR(function().opacity[1].y, pointAt(mouse).y, 1e-5f);
    click(within(curve, 0.3, 0.3));
    ASSERT_EQ(function().opacity.size(), 3u);
    click(within(curve, 0.3, 0.3), 1);
    EXPECT_EQ(function().opacity.size(), 2u);
    click(within(curve, 0.8, 0.9), 1);
    EXPECT_EQ(function().opacity.size(), 2u) << "two points stay";
}

TEST_F(TransferHands, EndsOfTheColourBarSetTheRange) {
    showTransfer();
    const Session before = session();
    const float y = strip.GetCenter().y;
    const double pixel = (shown.hi - shown.lo) / curve.GetWidth();
    drag({pixelOf(data.lo), y}, {pixelOf(data.lo) + 60, y});
    EXPECT_FALSE(function().autoRange);
    EXPECT_NEAR(function().range.lo, data.lo + 60 * pixel, pixel);
    EXPECT_EQ(function().range.hi, data.hi);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    drag({pixelOf(data.hi), y}, {pixelOf(data.hi) - 45, y});
    EXPECT_NEAR(function().range.hi, data.hi - 45 * pixel, pixel);
    EXPECT_EQ(function().range.lo, data.lo);
    const double top = function().range.hi;
    drag({pixelOf(data.lo), y}, {pixelOf(top) + 90, y});
    EXPECT_NEAR(function().range.lo, top - 1e-3 * (shown.hi - shown.lo), pixel * 1e-3) << "never past the other end";
    undo();
    drag(within(curve, 0.5, 0.5), within(curve, 0.5, 0.5));
    const vis::TransferFunction now = function();
    drag({curve.GetCenter().x, y}, {curve.GetCenter().x + 40, y});
    EXPECT_TRUE(function() == now) << "between the ends there is nothing to hold";
}

TEST_F(TransferHands, AnEndThatIsHeldStillStaysWhereItIs) {
    showTransfer();
    const float y = strip.GetCenter().y;
    moveTo({pixelOf(data.lo), y});
    button(0, true);
    moveTo({curve.Min.x - 80, y});
    EXPECT_NEAR(function().range.lo, shown.lo, 1e-9) << "as far as the plot shows";
    for (int i = 0; i < 5; ++i) frame();
    EXPECT_NEAR(function().range.lo, shown.lo, 1e-9);
    moveTo({pixelOf(data.lo) + 30, y});
    EXPECT_NEAR(function().range.lo, data.lo + 30 * (shown.hi - shown.lo) / curve.GetWidth(), 0.2)
        << "and comes back under the mouse";
    button(0, false);
}

} // namespace
} // namespace tessera::app
