#include "app/queries/branches.h"
#include "app/ui/ticks.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <gmock/gmock.h>

/// The mouse on a chain of brushes.
namespace tessera::app {
namespace {

using formula::Place;
using testing::HasSubstr;

class HierarchyHands : public Hands {
protected:
    static vis::Brush warm() { return vis::rangeBrush({{.channel = "T", .lo = 312, .hi = 1e9}}, "warm"); }
    void open(std::vector<vis::Brush> brushes, HierarchyView view = {}) {
        show(view, {900, 700}, [&](Session& edited) { edited.selection.brushes = std::move(brushes); });
    }
    const std::vector<vis::Brush>& brushes() { return session().selection.brushes; }
    std::string drawn() {
        std::string all;
        for (const DrawnText& each : drawnTexts()) all += each.text + "\n";
        return all;
    }
    ImRect plotOf(int level) { return item(window("levels"), {level, "plot"}); }
    /// The share of samples, by brute force.
    static double share(const std::function<bool(Place)>& counts) {
        double all = 0, own = 0;
        formula::forEachPlace([&](Place at) {
            all += 1;
            own += counts(at) ? 1 : 0;
        });
        return own / all;
    }
};

TEST_F(HierarchyHands, ADragInTheLastPlotAddsALevelAndTheNextOneFollows) {
    open({});
    EXPECT_THAT(drawn(), HasSubstr("Drag in the plot to add a level."));
    const ImRect first = plotOf(0);
    drag({first.Min.x + first.GetWidth() * 0.1f, first.GetCenter().y}, {first.Max.x - 3, first.GetCenter().y});
    settle();
    ASSERT_EQ(brushes().size(), 1u);
    const auto& made = std::get<vis::RangeRegion>(brushes()[0].region).intervals;
    ASSERT_EQ(made.size(), 1u);
    const std::string one = made[0].channel;
    const ImRect second = plotOf(1);
    drag({second.Min.x + second.GetWidth() * 0.1f, second.GetCenter().y}, {second.Max.x - 3, second.GetCenter().y});
    settle();
    ASSERT_EQ(brushes().size(), 2u);
    EXPECT_EQ(brushes()[1].combine, vis::BrushCombine::And);
    EXPECT_NE(brushes()[0].name, brushes()[1].name);
    EXPECT_NE(brushes()[0].color, brushes()[1].color);
    EXPECT_NE(std::get<vis::RangeRegion>(brushes()[1].region).intervals[0].channel, one) << "what no brush names yet";
    const double expected = share([&](Place at) {
        return vis::degreeOfInterest(session().selection, [&](const std::string& name) {
                   return formula::valueAt(name, at, 0.5).value_or(std::nan(""));
               }) >= 0.5;
    });
    EXPECT_GT(expected, 0);
    // Cells of a lattice are not all alike: the share of volume is near that of samples.
    const volume::Tally now = [&] {
        const auto numbers = workbench.numbers();
        const Branches read = readBranches(numbers, branchesQuery(session(), numbers->info()), 0);
        const volume::Tally own = read.selected(brushes(), 2);
        EXPECT_NEAR(own.samples / read.of({}).samples, expected, 1e-12);
        return volume::Tally{own.samples, own.volume / read.of({}).volume};
    }();
    EXPECT_THAT(drawn(), HasSubstr(formatShare(now.volume) + " of the box"));
    EXPECT_THAT(drawn(), HasSubstr(formatCount(now.samples) + " samples"));
}

TEST_F(HierarchyHands, ALevelIsEditedInItsPlaceAndKeepsItsName) {
    vis::Brush rich = vis::rangeBrush({{.channel = "c", .lo = -1e9, .hi = 1e9}}, "rich");
    vis::Brush cold = warm();
    cold.inverted = true;
    open({cold, rich});
    const vis::Brush second = brushes()[1];
    const ImRect plot = plotOf(0);
    drag({plot.Min.x + 4, plot.GetCenter().y}, {plot.Min.x + plot.GetWidth() * 0.3f, plot.GetCenter().y});
    settle();
    ASSERT_EQ(brushes().size(), 2u);
    EXPECT_EQ(brushes()[0].name, "warm");
    EXPECT_LT(std::get<vis::RangeRegion>(brushes()[0].region).intervals[0].hi, 1e6) << "drawn anew";
    EXPECT_TRUE(brushes()[0].inverted && brushes()[0].enabled);
    EXPECT_EQ(brushes()[1], second);
    shift = true; // which adds a brush in other plots
    drag({plot.Min.x + plot.GetWidth() * 0.6f, plot.GetCenter().y},
         {plot.Min.x + plot.GetWidth() * 0.9f, plot.GetCenter().y});
    shift = false;
    settle();
    ASSERT_EQ(brushes().size(), 2u) << "a level has one brush";
    EXPECT_EQ(brushes()[0].name, "warm");
    const auto& drawn = std::get<vis::RangeRegion>(brushes()[0].region).intervals[0];
    EXPECT_GT(drawn.hi - drawn.lo, 5) << "it follows the mouse";
    EXPECT_EQ(brushes()[1], second);
}

TEST_F(HierarchyHands, ButtonsDrillReorderAndInvert) {
    vis::Brush rich = vis::rangeBrush({{.channel = "c", .lo = -1e9, .hi = 1e9}}, "rich");
    open({warm(), rich});
    click(inPane({1, "> warm##crumb"}).GetCenter());
    EXPECT_TRUE(brushes()[0].enabled);
    EXPECT_FALSE(brushes()[1].enabled);
    settle();
    EXPECT_THAT(drawn(), HasSubstr("switched off"));
    click(inPane({2, "> rich##crumb"}).GetCenter());
    EXPECT_TRUE(brushes()[1].enabled);
    click(item(window("levels"), {0, "later"}).GetCenter());
    EXPECT_EQ(brushes()[0].name, "rich");
    click(item(window("levels"), {0, "##invert"}).GetCenter());
    settle();
    EXPECT_TRUE(brushes()[0].inverted);
    EXPECT_THAT(drawn(), HasSubstr("not rich"));
    click(inPane({0, "Everything##crumb"}).GetCenter());
    EXPECT_FALSE(brushes()[0].enabled || brushes()[1].enabled);
}

TEST_F(HierarchyHands, AClickOnAnAreaSelectsTheBranch) {
    open({warm()});
    const ImRect areas = item(window("branches"), {"areas"});
    click({areas.Max.x - 4, areas.GetCenter().y});
    settle();
    ASSERT_EQ(brushes().size(), 1u);
    EXPECT_TRUE(brushes()[0].enabled && brushes()[0].inverted) << "what is outside is at the right";
    click({areas.Min.x + 4, areas.GetCenter().y});
    EXPECT_FALSE(brushes()[0].inverted);
}

TEST_F(HierarchyHands, TheTimesAreThoseOfTheData) {
    open({warm()});
    const ImRect plot = item(window("times"), {"plots"});
    click({plot.Max.x - 2, plot.GetCenter().y});
    settle();
    EXPECT_EQ(session().time, formula::kTimes[2]);
}

} // namespace
} // namespace tessera::app
