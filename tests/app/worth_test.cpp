#include "app/edits/open_worth.h"
#include "app/session/session_json.h"
#include "app/views/worth/worth_data.h"
#include "volume/flow/flow_channels.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <gtest/gtest.h>

/// The list of what is worth seeing in words, as a table, and the views that it opens.
namespace tessera::app {
namespace {

using volume::Finding;
using volume::FindingKind;

std::shared_ptr<const volume::BrickSource> plantedCell() {
    static const auto source = volume::makeMemorySource(volume::makeModel("planted", {}), {});
    return source;
}

Session plantedSession() {
    DataRef data;
    data.model = "planted";
    Session session = defaultSession(plantedCell()->info(), data);
    session.views = {{"worth", WorthSeeingView{}}, {"volume", VolumeView{}}};
    session.dock = {};
    repair(session.dock, {"volume"});
    insertPane(session.dock, "worth", session.dock.root.id, DockSide::Left);
    session.time = 0.69;
    return session;
}

WorthQuestion asked(const Session& session, WorthList list = WorthList::Views) {
    WorthSeeingView view;
    view.list = list;
    const volume::DatasetInfo& info = plantedCell()->info();
    return worthQuestion(session, info, view,
                         {*info.findChannel("O2"), *info.findChannel("H2"), *info.findChannel("H2O"),
                          *info.findChannel("p"), *info.findChannel("T"), *info.findChannel("|U|")});
}

TEST(Worth, SentencesSayWhatWhereAndHowMuch) {
    const volume::DatasetInfo& info = plantedCell()->info();
    const WorthQuestion question = asked(plantedSession());
    const volume::WorthFindings answer = readWorth(plantedCell(), question, 0);
    std::string all;
    for (const Finding& each : answer.found) all += sentenceOf(each, question, info) + "\n";
    EXPECT_NE(all.find("T: 371.59 K"), std::string::npos) << all;
    EXPECT_NE(all.find("x 1.10, y 0.65, z 12.1 mm"), std::string::npos) << all;
    EXPECT_NE(all.find("H2O jumps to 22"), std::string::npos) << all;
    const WorthQuestion when = asked(plantedSession(), WorthList::When);
    const volume::WorthFindings changes = readWorth(plantedCell(), when, 0);
    ASSERT_FALSE(changes.found.empty());
    EXPECT_EQ(sentenceOf(changes.found[0], when, info).substr(0, 31), "H2 changes from 0.33 s to 0.69 ");
    EXPECT_EQ(asked(plantedSession(), WorthList::WhatElse).brushes.selection.active(), false);
    EXPECT_EQ(readWorth(plantedCell(), asked(plantedSession(), WorthList::WhatElse), 0).missing, "nothing is selected");
}

TEST(Worth, TheTableHasARowForEachFindingWithItsChance) {
    const volume::DatasetInfo& info = plantedCell()->info();
    const WorthQuestion question = asked(plantedSession());
    const volume::WorthFindings answer = readWorth(plantedCell(), question, 0);
    const Table table = worthTable(answer, question, info);
    EXPECT_EQ(rowsOf(table), answer.found.size());
    const std::string csv = csvOf(table);
    EXPECT_NE(csv.find("rank,kind,finding,number,p,q,samples,independent samples"), std::string::npos) << csv;
    EXPECT_NE(csv.find("# worth seeing: at t = 0.69 s, 14 443 samples"), std::string::npos) << csv;
    for (const double q : table.columns[5].numbers) EXPECT_LE(q, 0.05);
}

TEST(Worth, APlaceOpensSlicesThereWithABrushAroundIt) {
    const volume::DatasetInfo& info = plantedCell()->info();
    const Session before = plantedSession();
    Finding place{.kind = FindingKind::Outliers, .x = *info.findChannel("T")};
    place.place = {1.1e-3, 0.65e-3, 12.08e-3};
    place.box = {{0.9e-3, 0.55e-3, 11e-3}, {1.3e-3, 0.75e-3, 13e-3}};
    Session session = before;
    session.selection.brushes = {vis::rangeBrush({{.channel = "O2", .lo = 0, .hi = 1}}, "mine")};
    const std::string pane = openFinding(session, info, place, 12, "worth");
    ASSERT_TRUE(std::holds_alternative<SlicesView>(session.views.at(pane)));
    EXPECT_EQ(std::get<SlicesView>(session.views.at(pane)).channel, "T");
    EXPECT_EQ(session.cursor, place.place);
    EXPECT_DOUBLE_EQ(session.time, info.times[12]);
    ASSERT_EQ(session.selection.brushes.size(), 2u);
    EXPECT_FALSE(session.selection.brushes[0].enabled) << "the place alone is selected";
    const auto& box = std::get<vis::BoxRegion>(session.selection.brushes[1].region);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(box.center[axis] - box.radius[axis], place.box.lo[axis]);
        EXPECT_GT(box.center[axis] + box.radius[axis], place.box.hi[axis]);
    }
    EXPECT_EQ(stackWith(session.dock.root, pane), stackWith(session.dock.root, "volume")) << "the list stays in sight";
    const Session once = session;
    EXPECT_EQ(openFinding(session, info, place, 12, "worth"), pane);
    EXPECT_TRUE(session == once) << "the same view and brush are there once";
}

TEST(Worth, EachKindOpensItsView) {
    const volume::DatasetInfo& info = plantedCell()->info();
    const int o2 = *info.findChannel("O2"), water = *info.findChannel("H2O");
    Session session = plantedSession();
    Finding pair{.kind = FindingKind::Dependence, .x = o2, .y = water, .region = 4};
    const std::string scatter = openFinding(session, info, pair, 3, "worth");
    EXPECT_EQ(std::get<ScatterMatrixView>(session.views.at(scatter)).channels, (std::vector<std::string>{"O2", "H2O"}));
    ASSERT_EQ(session.selection.brushes.size(), 1u) << "of the region";
    EXPECT_TRUE(session.selection.brushes[0].enabled);
    Finding change{.kind = FindingKind::Change, .x = o2};
    change.time = 6;
    change.place = {1e-3, 1e-3, 1e-3};
    const std::string curves = openFinding(session, info, change, 3, "worth");
    EXPECT_EQ(std::get<CurvesView>(session.views.at(curves)).y.front(), "mean(O2)");
    EXPECT_DOUBLE_EQ(session.time, info.times[6]);
    EXPECT_EQ(session.cursor, change.place);
    Finding differs{.kind = FindingKind::Differs, .x = water};
    const vis::Selection selected = session.selection;
    const std::string histogram = openFinding(session, info, differs, 3, "worth");
    EXPECT_EQ(std::get<HistogramView>(session.views.at(histogram)).channel, "H2O");
    EXPECT_TRUE(session.selection == selected) << "what it is about stays selected";
    Finding region{.kind = FindingKind::Region, .region = 4};
    EXPECT_TRUE(std::get<StatisticsView>(session.views.at(openFinding(session, info, region, 3, "worth"))).byRegion);
    EXPECT_TRUE(sessionFromJson(toJson(session), "") == session) << "all of it is saved";
}

TEST(Worth, NumbersAreOfTheStoredTimeThatWasSearched) {
    volume::DatasetInfo info = plantedCell()->info();
    info.times = {0, 0.3, 0.69};
    Session session = plantedSession();
    session.time = 0.6;
    const WorthQuestion question = worthQuestion(session, info, WorthSeeingView{}, {*info.findChannel("O2")});
    EXPECT_EQ(searchedOrigin("as computed", question, info, {}).substr(0, 26), "as computed, at t = 0.69 s");
    WorthSeeingView when;
    when.list = WorthList::When;
    EXPECT_EQ(searchedOrigin("as computed", worthQuestion(session, info, when, {}), info, {}), "as computed");
    volume::WorthFindings answer;
    EXPECT_EQ(searchedText(answer, question, info).find("regions"), std::string::npos);
    answer.regionsLeft = 130;
    EXPECT_NE(searchedText(answer, question, info).find("without the 130 smallest regions"), std::string::npos);
}

TEST(Worth, OfUnevenTimesAChangeIsFastRatherThanMost) {
    volume::DatasetInfo info = plantedCell()->info();
    Finding change{.kind = FindingKind::Change, .x = *info.findChannel("O2")};
    change.first = 2, change.time = change.last = 3;
    const WorthQuestion when = asked(plantedSession(), WorthList::When);
    EXPECT_NE(sentenceOf(change, when, info).find("O2 changes most between"), std::string::npos);
    info.times.back() += 10;
    EXPECT_NE(sentenceOf(change, when, info).find("O2 changes more and faster than usual between"), std::string::npos);
    change.last = 5;
    EXPECT_NE(sentenceOf(change, when, info).find(", fastest between"), std::string::npos);
}

} // namespace
} // namespace tessera::app
