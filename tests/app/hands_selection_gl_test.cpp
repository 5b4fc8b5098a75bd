#include "app/session/own_functions.h"
#include "app/ui/ticks.h"
#include "app/workbench/workbench_commands.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <gmock/gmock.h>

/// The mouse on what is selected: names, places of extremes, probes, and the function of the layer selected.
namespace tessera::app {
namespace {

using formula::Place;

class SelectionHands : public Hands {
protected:
    /// Where a text was drawn last, that which lies rightmost.
    ImVec2 drawnAt(const std::string& text) {
        std::optional<DrawnText> found;
        for (const DrawnText& each : drawnTexts())
            if (each.text == text && (!found || each.min.x > found->min.x)) found = each;
        EXPECT_TRUE(found) << text;
        return found ? found->middle() : ImVec2{};
    }
    /// The place of a sample in space.
    static glm::dvec3 placeOf(Place at) {
        return {formula::kOrigin[0] + formula::kSpacing[0] * at.x, formula::kOrigin[1] + formula::kSpacing[1] * at.y,
                formula::kOrigin[2] + formula::kSpacing[2] * at.z};
    }
    struct Found {
        double value = 0;
        Place at;
    };
    /// By brute force, from the formula, where `counts`.
    static Found extremeOf(const std::string& channel, double time, bool greatest,
                           const std::function<bool(Place)>& counts) {
        std::optional<Found> best;
        formula::forEachPlace([&](Place at) {
            const auto value = formula::valueAt(channel, at, time);
            if (!value || !counts(at)) return;
            if (!best || (greatest ? *value > best->value : *value < best->value)) best = Found{*value, at};
        });
        return best.value();
    }
    void expectAt(Place at) { EXPECT_LT(glm::distance(session().cursor, placeOf(at)), 1e-9) << session().cursor.x; }
    void run(const std::string& name, const std::vector<Command>& commands) {
        for (const Command& command : commands)
            if (command.title() == name && command.available()) return command.run(), settle();
        ADD_FAILURE() << name;
    }
};

TEST_F(SelectionHands, ALayerThatIsClickedShowsItsFunction) {
    show(LayersView{}, {420, 900}, [](Session& edited) {
        edited.layers = {{"one", true, vis::VolumeLayer{.channel = "T"}},
                         {"two", true, vis::VolumeLayer{.channel = "c"}}};
        edited.layers[1].transfer = "mine";
        edited.transfer["mine"].colormap = "inferno";
        edited.views["function"] = TransferView{.channel = "T"};
    });
    const auto shown = [&] { return shownFunction(session(), std::get<TransferView>(session().views.at("function"))); };
    EXPECT_EQ(shown(), "T");
    click(item(window("layers"), {1, "##row"}).GetCenter());
    EXPECT_EQ(shown(), "mine") << "what the layer is drawn with";
    click(item(window("layers"), {0, "##row"}).GetCenter());
    EXPECT_EQ(shown(), "T");
    // Shows another parameter: what was made for the former one does not fit.
    const auto before = ownFunctions(session());
    std::get<vis::VolumeLayer>(session().layers[1].technique).channel = "T";
    dropFormerFunction(session(), session().layers[1], before, workbench.numbers()->info());
    EXPECT_EQ(session().layers[1].transfer, "");
    EXPECT_FALSE(session().transfer.contains("mine"));
}

TEST_F(SelectionHands, AClickOnAnExtremeGoesToItsPlace) {
    const Range hot{318.5, 1e9};
    StatisticsView statistics;
    statistics.channels = {"T"};
    show(statistics, {1100, 300}, [&](Session& edited) {
        edited.selection.brushes = {vis::rangeBrush({{.channel = "T", .lo = hot.lo, .hi = hot.hi}}, "hot")};
    });
    const auto selected = [&](Place at) { return formula::valueAt("T", at, 0.5).value() >= hot.lo; };
    const Found least = extremeOf("T", 0.5, false, selected);
    const Range range = formula::rangeOf("T");
    const auto text = [&](double value) { return formatNumber(value, (range.hi - range.lo) / 10000); };
    for (int i = 0; i < 4; ++i) frame(); // until the columns have their widths
    click(drawnAt(text(least.value)));
    settle();
    expectAt(least.at);
    EXPECT_EQ(session().time, 0.5);
    const Found other = extremeOf("T", 0.5, true, [&](Place at) { return !selected(at); });
    click(drawnAt(text(other.value)));
    settle();
    expectAt(other.at);
    EXPECT_THAT(workbench.messages().list().back().text, testing::HasSubstr("maximum of T in not hot: "));
}

TEST_F(SelectionHands, ExtremesOverAllTimesTakeTheTimeAlong) {
    show(DataView{}, {420, 1200});
    const auto everywhere = [](Place) { return true; };
    std::optional<Found> most;
    double when = 0;
    for (const double time : formula::kTimes)
        if (const Found here = extremeOf("T", time, true, everywhere); !most || here.value > most->value)
            most = here, when = time;
    const Range range = formula::rangeOf("T");
    click(drawnAt(formatNumber(most->value, (range.hi - range.lo) / 1000)));
    settle();
    expectAt(most->at);
    EXPECT_EQ(session().time, when);
}

TEST_F(SelectionHands, ThePaletteKnowsTheExtremesOfEveryParameter) {
    show(StatisticsView{}, {700, 300}, [](Session& edited) {
        vis::Brush box;
        box.name = "inlet";
        box.region = vis::BoxRegion{.center = {0.0105, 0.006, 0}, .radius = {0.0008, 1, 1}};
        edited.selection.brushes = {box};
    });
    const auto inlet = [](Place at) { return std::abs(placeOf(at).x - 0.0105) <= 0.0008; };
    const auto everywhere = [](Place) { return true; };
    run("Go to the maximum of c in inlet", extremesOfParameters(workbench));
    expectAt(extremeOf("c", 0.5, true, inlet).at);
    run("Go to the maximum of c everywhere", extremesOfParameters(workbench));
    expectAt(extremeOf("c", 0.5, true, everywhere).at);
    run("Go to the minimum of |U| in inlet", extremesOfParameters(workbench));
    EXPECT_EQ(session().time, 0.5);
    run("Go to the minimum of T over all times everywhere", extremesOfParameters(workbench));
    EXPECT_EQ(session().time, 0) << "the time goes there, too";
    run("Go to the maximum", workbench.commands());
    expectAt(extremeOf("T", 0, true, inlet).at);
}

TEST_F(SelectionHands, ProbesAreKeptNamedAndGoneTo) {
    show(ProbesView{.channels = {"T"}}, {900, 300});
    run("Keep the values here", workbench.commands());
    ASSERT_EQ(session().probes.size(), 1u);
    EXPECT_EQ(session().probes[0].position, glm::dvec3(0.0123, 0.0041, -0.0009));
    session().cursor = placeOf({2, 3, 4});
    session().time = 2;
    settle();
    click(inPane({"##add"}).GetCenter());
    settle();
    ASSERT_EQ(session().probes.size(), 2u);
    EXPECT_EQ(session().probes[1].name, "probe 2");
    const std::string value = formatNumber(formula::valueAt("T", {2, 3, 4}, 2).value(),
                                           (formula::rangeOf("T").hi - formula::rangeOf("T").lo) / 10000);
    EXPECT_THAT(drawnWords(), testing::Contains(value)) << "of the sample there";
    click(drawnAt("probe 1"));
    settle();
    EXPECT_EQ(session().cursor, session().probes[0].position);
    EXPECT_EQ(session().time, 0.5);
    click(inPane({"##remove"}).GetCenter());
    ASSERT_EQ(session().probes.size(), 1u);
    EXPECT_EQ(session().probes[0].name, "probe 2");
}

} // namespace
} // namespace tessera::app
