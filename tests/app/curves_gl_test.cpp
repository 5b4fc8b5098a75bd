// The view of curves over time, by the mouse: its default, the polarisation curve, and going to a state.
#include "app/views/curves/curves_data.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "volume/base/error.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

namespace tessera::app {
namespace {

class CurvesViewTest : public ViewsTest {
protected:
    void SetUp() override {
        ViewsTest::SetUp();
        volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}});
        cell.info.quantities = {{"voltage", "V", {0.7, 0.5, 0.6, 0.4}},
                                {"current_density", "A/m2", {4000, 17000, 9000, 25000}}};
        show(volume::makeMemorySource(std::move(cell), {.lattice = volume::LatticeKind::CC}));
        session.time = source->info().times[0];
    }
    void drawFrame() {
        frame([&] { draw("curves", curvesView, drawCurvesView, {640, 480}); });
    }
    void press(bool down) { ImGui::GetIO().MouseDown[0] = down; }
    void click(ImVec2 at) {
        mouse = at;
        drawFrame();
        press(true);
        drawFrame();
        press(false);
        drawFrame();
    }
};

TEST_F(CurvesViewTest, ShowsThePolarisationCurveAtOnceAndADragGoesToItsStates) {
    const CurvesView shown = resolvedCurves(curvesView, source->info());
    EXPECT_EQ(shown.x, "current_density");
    EXPECT_EQ(shown.y, (std::vector<std::string>{"voltage"}));
    drawFrame();
    EXPECT_TRUE(messages.empty());
    const CurvesView before = curvesView;
    std::set<double> visited;
    mouse = {60, 60};
    drawFrame();
    mouse = {300, 200};
    drawFrame();
    press(true);
    drawFrame(); // the drag begins on the plot
    for (float y = 60; y < 440; y += 5)
        for (float x = 40; x < 630; x += 9) {
            mouse = {x, y};
            drawFrame();
            visited.insert(session.time);
        }
    press(false);
    const std::vector<double>& times = source->info().times;
    EXPECT_EQ(visited, std::set<double>(times.begin(), times.end())); // every state, and nothing between
    EXPECT_TRUE(curvesView == before);
}

TEST_F(CurvesViewTest, AClickBringsBackThePolarisationCurve) {
    curvesView.x = "time";
    curvesView.y = {"mean(T)"};
    const std::vector<std::string> voltage{"voltage"};
    bool found = false;
    for (float x = 8; x < 632 && !found; x += 12)
        for (int twice = 0; twice < 2 && !found; ++twice) { // the first click may close a list
            click({x, 18});
            found = curvesView.x == "current_density" && curvesView.y == voltage;
        }
    EXPECT_TRUE(found);
}

TEST_F(CurvesViewTest, ABadFormulaOrRegionIsTold) {
    curvesView.y = {"mean(nothing)"};
    drawFrame();
    curvesView.y = {"mean(T)"};
    curvesView.region = "nowhere";
    drawFrame();
    EXPECT_THROW(plotCurvesQuery(curvesView, session, source->info()), Error);
    curvesView.region.clear();
    drawFrame();
    EXPECT_NO_THROW(plotCurvesQuery(curvesView, session, source->info()));
}

TEST_F(CurvesViewTest, StatisticsOfABrushAreThoseOfTheStatisticsView) {
    vis::Brush brush;
    const auto channel = source->info().findChannel("T");
    ASSERT_TRUE(channel);
    const Range range = source->info().channelRange(source->info().channel(*channel));
    vis::RangeRegion region;
    region.intervals = {{.channel = "T", .lo = (range.lo + range.hi) / 2, .hi = range.hi}};
    brush.region = region;
    session.selection.brushes = {brush};
    curvesView.y = {"mean(T)", "share(T)", "volume(T)"};
    curvesView.brushed = true;
    const volume::Curves curves = readCurves(*source, {}, plotCurvesQuery(curvesView, session, source->info()));
    for (std::size_t t = 0; t < curves.times.size(); ++t) {
        session.time = curves.times[t];
        BrushedQuery query = brushedQuery(session, source->info(), {*channel}, {range}, 8, false);
        const volume::ChannelStatistics own = readStatistics(source, query, 0).channels[0];
        ASSERT_GT(own.inside.samples, 0);
        EXPECT_NEAR(curves.y[0].values[t], own.inside.mean, 1e-9 * range.hi);
        EXPECT_NEAR(curves.y[1].values[t], own.inside.samples / own.all.samples, 1e-12);
        EXPECT_NEAR(curves.y[2].values[t], own.inside.volume, 1e-12 * own.inside.volume);
    }
}

TEST_F(CurvesViewTest, TablesAndFiguresHoldTheCurves) {
    curvesView.x = "current_density";
    curvesView.y = {"voltage", "voltage*current_density"};
    const volume::Curves curves = readCurves(*source, {}, plotCurvesQuery(curvesView, session, source->info()));
    const std::string csv = csvOf(curvesTable(curves));
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "time [s],current_density [A/m2],voltage [V],voltage*current_density [W/m2]");
    EXPECT_NE(csv.find(",17000,0.5,8500\n"), std::string::npos);
    const std::string svg = svgOf(curvesDrawing(curves, curves.times[1]));
    EXPECT_NE(svg.find("voltage [V]"), std::string::npos);
    std::size_t rings = 0;
    for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++rings;
    EXPECT_EQ(rings, 2 * (4 + 1)); // four states of two curves, and the marked one
}

TEST_F(CurvesViewTest, APictureSaysWhatItsAxisIsAndWhichCurveIsWhich) {
    curvesView.x = "time";
    curvesView.y = {"mean(T)", "max(T)"};
    figure = true;
    const auto words = [&] {
        for (int i = 0; i < 3; ++i) {
            drawFrame();
            jobs.wait();
        }
        std::vector<std::string> all = drawnWords();
        return std::set<std::string>(all.begin(), all.end());
    };
    const auto numbered = [](const std::set<std::string>& all) {
        return std::ranges::any_of(all, [](const std::string& each) { return each.starts_with("max(T) [K]  "); });
    };
    const std::set<std::string> marked = words();
    EXPECT_TRUE(marked.contains("T [K]")) << "the vertical axis";
    EXPECT_TRUE(numbered(marked));
    EXPECT_FALSE(app::drawnIn(plotColors().cursor).empty()) << "the state now";
    decoration.cursor = false;
    const std::set<std::string> plain = words();
    EXPECT_TRUE(plain.contains("mean(T) [K]"));
    EXPECT_FALSE(numbered(plain));
    EXPECT_TRUE(app::drawnIn(plotColors().cursor).empty());
    for (const bool dark : {false, true})
        for (std::size_t a = 0; a < 6; ++a)
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GT(glm::distance(plotInk(a, dark), plotInk(b, dark)), 0.2f) << a << " " << b << " " << dark;
}

} // namespace
} // namespace tessera::app
