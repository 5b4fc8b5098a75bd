#include "app/values/selection_text.h"

#include <gmock/gmock.h>

namespace tessera::app {
namespace {

using testing::ElementsAre;

volume::DatasetInfo smallInfo() {
    volume::DatasetInfo info;
    info.lengthUnit = "mm";
    info.parameters.resize(2);
    info.parameters[0].name = "O2";
    info.parameters[0].unit = "mol/m3";
    info.parameters[0].ranges = {{0, 8}};
    info.parameters[1].name = "T";
    info.parameters[1].unit = "K";
    info.parameters[1].ranges = {{300, 400}};
    return info;
}

vis::Brush ofRange(const std::string& channel, double lo, double hi, const std::string& name) {
    return vis::rangeBrush({{.channel = channel, .lo = lo, .hi = hi}}, name);
}

TEST(SelectionText, ASelectionHasTheNamesOfItsBrushes) {
    Session session;
    EXPECT_EQ(selectionName(session), "");
    session.selection.brushes = {ofRange("O2", 0, 0.2, "starved"), ofRange("T", 350, 400, "hot"),
                                 ofRange("T", 390, 400, "burnt")};
    session.selection.brushes[1].enabled = session.selection.brushes[2].enabled = false;
    EXPECT_EQ(selectionName(session), "starved");
    EXPECT_EQ(restName(selectionName(session)), "not starved");
    session.selection.brushes[0].inverted = true;
    EXPECT_EQ(selectionName(session), "not starved");
    EXPECT_EQ(restName(selectionName(session)), "starved");
    session.selection.brushes[0].inverted = false;
    session.selection.brushes[1].enabled = true;
    EXPECT_EQ(selectionName(session), "starved and hot");
    EXPECT_EQ(restName(selectionName(session)), "not (starved and hot)");
    session.selection.brushes[2].enabled = true;
    session.selection.brushes[1].combine = vis::BrushCombine::Or;
    session.selection.brushes[2].combine = vis::BrushCombine::Minus;
    EXPECT_EQ(selectionName(session), "(starved or hot) without burnt");
    nameSelection(session, "trouble");
    EXPECT_EQ(selectionName(session), "trouble");
    EXPECT_EQ(session.selection.brushes[0].name, "starved") << "keeps its own";
    session.selection.brushes[1].enabled = session.selection.brushes[2].enabled = false;
    EXPECT_EQ(selectionName(session), "starved") << "a lone brush has its own name";
    nameSelection(session, "poor");
    EXPECT_EQ(session.selection.brushes[0].name, "poor");
}

TEST(SelectionText, LensesThatMarkHaveNames) {
    Session session;
    session.lenses.resize(2);
    session.lenses[0].name = "inlet";
    session.lenses[1].name = "outlet";
    session.lenses[0].marks = session.lenses[1].marks = true;
    EXPECT_EQ(selectionName(session), "lens inlet, outlet");
    session.lenses[1].enabled = false;
    EXPECT_EQ(selectionName(session), "lens inlet");
}

TEST(SelectionText, DefinitionsStateWhatIsMeantWithUnits) {
    const volume::DatasetInfo info = smallInfo();
    Session session;
    vis::Brush both = vis::rangeBrush(
        {{.channel = "O2", .lo = 0.125, .hi = 0.25, .soft = 0.5}, {.channel = "T", .lo = 350, .hi = 400}}, "starved");
    session.selection.brushes = {both};
    EXPECT_THAT(selectionNotes(session, info),
                ElementsAre("selection \"starved\": O2 0.125 .. 0.25 mol/m\u00b3 (soft edge 0.5 mol/m\u00b3), "
                            "T 350 .. 400 K"));
    session.selection.brushes[0].inverted = true;
    EXPECT_THAT(selectionNotes(session, info)[0], testing::StartsWith("selection \"not starved\": all but O2"));
    session.selection.brushes[0].inverted = false;
    vis::Brush ball;
    ball.name = "ball";
    ball.combine = vis::BrushCombine::Or;
    ball.region = vis::SphereRegion{.center = {1, 2, 3}, .radius = {4, 5, 6}, .soft = 0.1};
    session.selection.brushes.push_back(ball);
    const auto notes = selectionNotes(session, info);
    ASSERT_EQ(notes.size(), 3u);
    EXPECT_EQ(notes[0], "selection \"starved or ball\"");
    EXPECT_EQ(notes[2],
              "brush \"ball\": sphere 8 \u00d7 10 \u00d7 12 mm around x 1, y 2, z 3 mm (soft edge 10 % of the radius)");
}

TEST(SelectionText, SamplesThatAreNotWholeAreCalledWeighted) {
    TableColumn samples{.name = "samples", .head = "Samples", .kind = NumberKind::Count, .numbers = {3, 4}};
    sayWeighted(samples);
    EXPECT_EQ(samples.name, "samples");
    samples.numbers[1] = 4.26;
    sayWeighted(samples);
    EXPECT_EQ(samples.name, "weightedSamples");
    EXPECT_EQ(headOf(samples), "Weighted samples");
    EXPECT_EQ(cellOf(samples, 1), "4.3") << "not rounded to a whole number";
    TableColumn of{.name = "samples in starved", .numbers = {0.5}};
    sayWeighted(of);
    EXPECT_EQ(of.name, "weighted samples in starved");
}

} // namespace
} // namespace tessera::app
