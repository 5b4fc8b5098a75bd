#include "app/history/history.h"
#include "cell_info.h"
#include "randomise.h"

#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace tessera::app {
namespace {

TEST(HistoryTest, UndoAllAndRedoAllOfRandomEdits) {
    std::mt19937 random(5);
    Session session = defaultSession(cellInfo(), {});
    session.animation.playing = false; // what plays is no edit
    session.animation.position = 0;
    History history;
    history.reset(session);
    std::vector<Session> states{session};
    for (int i = 0; i < 60; ++i) {
        Session next = i % 7 == 0 ? randomValue<Session>(random) : session;
        next.schema = kSessionSchema;
        next.animation.playing = false;
        next.animation.position = 0;
        next.dock.volume.clear(); // nor is what was clicked
        if (i % 7 != 0) {
            next.camera.distance = 1 + float(i) / 10;
            if (i % 3 == 0) next.layers.push_back(randomValue<vis::Layer>(random));
            if (i % 5 == 0 && !next.layers.empty()) next.layers.erase(next.layers.begin());
        }
        if (next == session) continue;
        ASSERT_TRUE(history.observe(next, false, i * 10.0)) << i;
        session = next;
        states.push_back(session);
    }
    ASSERT_EQ(history.steps().size() + 1, states.size());
    for (std::size_t i = states.size(); i-- > 1;) ASSERT_TRUE(history.undo() == states[i - 1]) << i;
    EXPECT_FALSE(history.canUndo());
    for (std::size_t i = 1; i < states.size(); ++i) ASSERT_TRUE(history.redo() == states[i]) << i;
    EXPECT_FALSE(history.canRedo());
    EXPECT_TRUE(history.seek(3) == states[3]);
    const History again = History::fromJson(history.toJson(), states[3]);
    EXPECT_TRUE(again == history);
    EXPECT_THROW(History::fromJson(history.toJson(), states[4]), Error);
    // Forty copies of the document into itself would be a million million of them.
    Json bomb = history.toJson();
    bomb["steps"][0]["forward"] = Json::parse(R"([{"op":"copy","from":"","path":"/more"}])");
    EXPECT_THAT([&] { History::fromJson(bomb, states[3]); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("not a JSON patch")));
}

TEST(HistoryTest, ADragIsOneStepAndAWheelTurnIsOneStep) {
    Session session;
    History history;
    history.reset(session);
    for (int i = 0; i < 20; ++i) {
        session.camera.distance += 0.1f;
        EXPECT_FALSE(history.observe(session, true, i * 0.02));
    }
    EXPECT_TRUE(history.observe(session, false, 0.4));
    EXPECT_EQ(history.steps().size(), 1u);
    for (int i = 0; i < 5; ++i) {
        session.time += 1;
        history.observe(session, false, 10 + i * 0.1);
    }
    EXPECT_EQ(history.steps().size(), 2u);
    EXPECT_EQ(history.steps()[1].name, "time");
    EXPECT_EQ(history.undo().time, 0);
}

// However soon one follows the other: of both in one step nothing would be left, or neither could be undone alone.
TEST(HistoryTest, WhatComesAndGoesIsAStepEach) {
    Session session;
    History history;
    history.reset(session);
    double seconds = 1;
    std::vector<Session> states{session};
    const auto then = [&](const std::function<void()>& edit) {
        edit();
        EXPECT_TRUE(history.observe(session, false, seconds += 0.1));
        states.push_back(session);
        EXPECT_EQ(history.steps().size(), states.size() - 1);
    };
    then([&] { session.transfer["T"] = {}; });
    then([&] { session.transfer.erase("T"); });
    then([&] { session.transfer["T"] = {}; });
    then([&] { session.selection.brushes.push_back({}); });
    then([&] { session.selection.brushes.push_back({}); });
    then([&] { session.selection.brushes.clear(); });
    for (std::size_t i = states.size() - 1; i-- > 0;) EXPECT_TRUE(history.undo() == states[i]) << i;
}

TEST(HistoryTest, PlayingIsNoEdit) {
    Session session;
    History history;
    history.reset(session);
    session.animation.playing = true;
    for (int i = 0; i < 5; ++i) {
        session.time += 1;
        EXPECT_FALSE(history.observe(session, false, i));
    }
    session.animation.playing = false;
    EXPECT_FALSE(history.observe(session, false, 9));
    session.camera.distance = 7;
    EXPECT_TRUE(history.observe(session, false, 20));
    EXPECT_EQ(history.steps().size(), 1u);
    EXPECT_EQ(history.undo().time, 5);
}

TEST(HistoryTest, AHistoryFitsASessionWhoseTimePlayedOn) {
    Session session = defaultSession(cellInfo(), {});
    session.animation.playing = false;
    History history;
    history.reset(session);
    session.time = 1;
    ASSERT_TRUE(history.observe(session, false, 1));
    session.animation.playing = true;
    session.time = 3;
    EXPECT_FALSE(history.observe(session, false, 20));
    session.animation.playing = false;
    EXPECT_FALSE(history.observe(session, false, 21));
    History again = History::fromJson(history.toJson(), session);
    EXPECT_EQ(again.steps().size(), 1U);
    EXPECT_EQ(again.undo().time, 0);
    EXPECT_EQ(again.redo().time, 1);

    // Nor does a keyframe's parameter end where an edit left it. A rotation is not normalised again for that.
    session.animation.tracks.push_back({"/camera/orientation", {{0, {1, 0, 0, 0}}, {4, {0, 1, 0, 0}}}});
    session.camera.orientation = {0.6770412f, 0.24378258f, 0.66876096f, 0.18693383f};
    ASSERT_TRUE(history.observe(session, false, 40));
    session.animation.playing = true;
    session.camera.orientation = {0.7f, 0.7f, 0.1f, 0.1f};
    EXPECT_FALSE(history.observe(session, false, 60));
    session.animation.playing = false;
    EXPECT_FALSE(history.observe(session, false, 61));
    EXPECT_EQ(History::fromJson(history.toJson(), session).steps().size(), 2U);
}

TEST(HistoryTest, WhichTabsAreInFrontIsNoEdit) {
    Session session;
    session.dock.root.id = 1;
    session.dock.root.tabs = {"a", "b", "c"};
    History history;
    history.reset(session);
    session.dock.root.active = 1;
    EXPECT_FALSE(history.observe(session, false, 1));
    EXPECT_FALSE(history.pending());
    // A pane that comes is one; what is undone and done again lets the tabs be.
    session.dock.root.tabs.push_back("d");
    session.dock.root.active = 3;
    EXPECT_TRUE(history.observe(session, false, 2));
    session.camera.distance = 7;
    EXPECT_TRUE(history.observe(session, false, 3));
    session.dock.root.active = 2;
    EXPECT_FALSE(history.observe(session, false, 4));
    EXPECT_EQ(history.steps().size(), 2u);
    EXPECT_TRUE(History::fromJson(history.toJson(), session).steps().size() == 2) << "as saved";
    EXPECT_EQ(history.undo().dock.root.active, 2);
    EXPECT_EQ(history.undo().dock.root.tabs.size(), 3u);
    EXPECT_EQ(history.redo().dock.root.tabs.size(), 4u);
    EXPECT_EQ(history.redo().camera.distance, 7);
}

TEST(HistoryTest, WhichTabIsInFrontWithinAPaneIsNoEdit) {
    Session session;
    session.views["layers"] = LayersView{};
    History history;
    history.reset(session);
    const auto layers = [](Session& of) -> LayersView& { return std::get<LayersView>(of.views.at("layers")); };
    layers(session).task = SceneTask::Lenses;
    EXPECT_FALSE(history.observe(session, false, 1));
    EXPECT_FALSE(history.pending());
    session.camera.distance = 7;
    layers(session).task = SceneTask::Light;
    EXPECT_TRUE(history.observe(session, false, 2));
    ASSERT_EQ(history.steps().size(), 1u);
    EXPECT_EQ(history.steps()[0].forward.size(), 1u) << "the camera alone";
    layers(session).task = SceneTask::Clips;
    EXPECT_FALSE(history.observe(session, false, 3));
    EXPECT_EQ(History::fromJson(history.toJson(), session).steps().size(), 1u) << "as saved";
    Session back = history.undo();
    EXPECT_EQ(layers(back).task, SceneTask::Clips) << "what is undone lets it be";
    EXPECT_NE(back.camera.distance, 7);
    layers(session).selected = 1; // another layer is one
    session.camera = back.camera;
    EXPECT_TRUE(history.observe(session, false, 9));
}

TEST(HistoryTest, AStepMayHaveAName) {
    Session session;
    History history;
    history.reset(session);
    for (const char* name : {"Layout: Lens", "Layout: Flow"}) {
        history.nameNext(name);
        session.camera.distance += 1;
        session.time += 1;
        EXPECT_TRUE(history.observe(session, false, 1));
    }
    history.nameNext("Layout: Flow");
    EXPECT_FALSE(history.observe(session, false, 1)) << "it is shown already";
    session.camera.distance += 1;
    session.time += 1;
    EXPECT_TRUE(history.observe(session, false, 1));
    ASSERT_EQ(history.steps().size(), 3u) << "none joins the one before";
    EXPECT_EQ(history.steps()[0].name, "Layout: Lens");
    EXPECT_EQ(history.steps()[1].name, "Layout: Flow");
    EXPECT_EQ(history.steps()[2].name, "camera and time");
}

TEST(HistoryTest, ANameIsForTheNextEditNotForOneAfterUndo) {
    Session session;
    History history;
    history.reset(session);
    session.camera.distance = 5;
    EXPECT_TRUE(history.observe(session, false, 1));
    history.nameNext("Layout: Lens");
    session = history.undo();
    session.time = 3;
    EXPECT_TRUE(history.observe(session, false, 10));
    ASSERT_EQ(history.steps().size(), 1u);
    EXPECT_EQ(history.steps()[0].name, "time");
}

// The last step of the file is undone alone, however soon after opening it the same setting is changed again.
TEST(HistoryTest, NoEditJoinsAStepThatWasSaved) {
    Session session;
    History history;
    history.reset(session);
    session.camera.distance = 5;
    EXPECT_TRUE(history.observe(session, false, 1));
    History opened = History::fromJson(history.toJson(), session);
    session.camera.distance = 6;
    EXPECT_TRUE(opened.observe(session, false, 0.1));
    EXPECT_EQ(opened.steps().size(), 2u);
    EXPECT_EQ(opened.undo().camera.distance, 5);
}

TEST(HistoryTest, APartOfALayerThatComesIsNoNewLayer) {
    Session session;
    session.layers = {{"O2", true, vis::VolumeLayer{.channel = "O2"}}};
    History history;
    history.reset(session);
    std::get<vis::VolumeLayer>(session.layers[0].technique).look.wire.emplace();
    EXPECT_TRUE(history.observe(session, false, 1));
    EXPECT_EQ(history.steps().at(0).name, "O2: look");
    session.layers.push_back({"H2", true, vis::VolumeLayer{.channel = "H2"}});
    EXPECT_TRUE(history.observe(session, false, 10));
    EXPECT_EQ(history.steps().at(1).name, "H2 added");
}

} // namespace
} // namespace tessera::app
