#include "app/document/autosaver.h"
#include "app/document/document.h"
#include "app/document/tracked.h"
#include "volume/base/error.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

/// What is open, without a window.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

Opened smallData(int times = 3) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 8}, {"ny", 8}, {"nz", 8}, {"times", double(times)}};
    return open(request);
}

struct DocumentTest : testing::Test {
    Document document;
    fs::path folder = fs::temp_directory_path() / ("tessera-document-test-" + std::to_string(getpid()));

    void SetUp() override {
        fs::remove_all(folder);
        fs::create_directories(folder);
        document.install(smallData());
    }
    void TearDown() override { fs::remove_all(folder); }
    /// An edit that is finished.
    void edit() {
        document.session().title += "!";
        EXPECT_TRUE(document.observe(false, clock += 10));
    }
    double clock = 0;
};

TEST(EmptyDocument, IsNothingToSave) {
    Document document;
    EXPECT_FALSE(document.loaded());
    EXPECT_FALSE(document.dirty());
    EXPECT_EQ(document.windowTitle(), "Tessera");
    document.stepTime(1);
    document.session().title = "edited";
    EXPECT_FALSE(document.observe(false, 1)) << "nothing is open that could be edited";
}

TEST_F(DocumentTest, SaysWhetherThereIsSomethingToSave) {
    document.session().title = "cell";
    EXPECT_EQ(document.windowTitle(), "cell * - Tessera");
    const std::string path = (folder / "a.tessera.json").string();
    document.save(path);
    EXPECT_FALSE(document.dirty());
    EXPECT_TRUE(document.asSaved());
    EXPECT_EQ(document.windowTitle(), "a.tessera.json - Tessera");
    EXPECT_EQ(loadSession(path).session.title, "cell");
    document.session().camera.distance *= 2;
    document.session().time = document.info().times.back();
    std::get<LayersView>(document.session().views.at("layers")).task = SceneTask::Light;
    EXPECT_FALSE(document.dirty()) << "looking around loses nothing";
    EXPECT_FALSE(document.asSaved());
    document.setUnsaved();
    EXPECT_TRUE(document.dirty());
    EXPECT_THROW(document.save((folder / "no" / "folder.json").string()), Error);
    EXPECT_EQ(document.path(), path);
}

TEST_F(DocumentTest, EditsAreStepsThatGoBackAndForth) {
    const std::string before = document.session().title;
    edit();
    edit();
    EXPECT_EQ(document.history().steps().size(), 2u);
    document.undo();
    EXPECT_EQ(document.session().title, before + "!");
    document.redo();
    EXPECT_EQ(document.session().title, before + "!!");
    document.goToStep(0);
    EXPECT_EQ(document.session().title, before);
    Session other = document.session();
    other.title = "other";
    other.animation.playing = true;
    document.replace(other, "Layout: Other");
    EXPECT_FALSE(document.session().animation.playing);
    EXPECT_TRUE(document.observe(false, clock += 10));
    EXPECT_EQ(document.history().steps().back().name, "Layout: Other");
}

TEST_F(DocumentTest, WhatIsSavedDuringAnEditHasItAsItsLastStep) {
    const double before = document.session().camera.distance;
    edit();
    document.session().camera.distance *= 2;
    EXPECT_FALSE(document.observe(true, clock)) << "a button is held";
    const std::string path = (folder / "a.tessera.json").string();
    document.save(path);
    SessionDocument saved = loadSession(path);
    EXPECT_EQ(saved.messages, std::vector<std::string>()) << "its history is whole";
    EXPECT_TRUE(saved.session == document.session());
    ASSERT_EQ(saved.history.steps().size(), 2U);
    EXPECT_EQ(saved.history.undo().camera.distance, before);
    EXPECT_EQ(document.history().steps().size(), 1U) << "here the edit goes on";
}

TEST_F(DocumentTest, StepsThroughStoredTimesAndStopsAtTheEnds) {
    const std::vector<double> times = document.info().times;
    document.session().time = times[0];
    document.session().animation.playing = true;
    document.stepTime(-1);
    EXPECT_EQ(document.session().time, times[0]);
    EXPECT_FALSE(document.session().animation.playing);
    document.stepTime(1);
    EXPECT_EQ(document.session().time, times[1]);
    document.stepTime(5);
    EXPECT_EQ(document.session().time, times[2]);
}

TEST_F(DocumentTest, MovesToDataMadeOfThoseShownOnly) {
    edit();
    const std::size_t edits = document.edits();
    RemadeData made{nullptr, smallData(4).sources(), document.session().data, {}};
    made.data.settings["times"] = 4;
    const Session before = document.session();
    EXPECT_FALSE(document.moveTo(made)) << "of other data";
    EXPECT_TRUE(document.session() == before);
    EXPECT_EQ(document.edits(), edits);
    made.from = document.sources().pictures;
    document.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    ASSERT_TRUE(document.moveTo(made));
    EXPECT_EQ(document.info().times.size(), 4u);
    EXPECT_EQ(document.session().data.settings.at("times"), 4);
    EXPECT_EQ(document.session().data.derived.size(), 1u) << "edited meanwhile";
    EXPECT_TRUE(document.history().data().derived.empty()) << "and still to become a step";
    EXPECT_EQ(document.session().title, before.title);
    EXPECT_GT(document.edits(), edits);
}

TEST_F(DocumentTest, WhatIsEditedIsKeptAfterTheIntervalUntilItIsSaved) {
    Jobs jobs;
    Messages messages([] { return 0.0; });
    Autosaver autosaver(folder.string(), std::chrono::seconds(10));
    const auto kept = [&](double now) {
        autosaver.update(document, now, jobs, messages);
        jobs.wait();
        jobs.collect();
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".json") return loadSession(entry.path().string()).session.title;
        return std::string("nothing");
    };
    autosaver.clear(document);
    EXPECT_EQ(kept(100), "nothing");
    EXPECT_EQ(autosaver.secondsToNext(document, 100), std::numeric_limits<double>::infinity());
    edit();
    EXPECT_EQ(kept(100), document.session().title);
    const std::string first = document.session().title;
    edit();
    EXPECT_DOUBLE_EQ(autosaver.secondsToNext(document, 103), 7);
    EXPECT_EQ(kept(109), first) << "not yet";
    autosaver.hurry();
    EXPECT_EQ(kept(109), document.session().title);
    autosaver.clear(document);
    EXPECT_EQ(kept(200), "nothing");
    EXPECT_TRUE(messages.list().empty());
}

TEST(Tracked, IsMadeOnceAndGivenUpWhenTakenBack) {
    using Step = Tracked<int>::Step;
    Tracked<int> value;
    value.settle(1);
    EXPECT_EQ(value.next(1), Step::None);
    EXPECT_EQ(value.next(2, true), Step::None) << "still being edited";
    EXPECT_EQ(value.next(2), Step::Make);
    EXPECT_EQ(value.next(2), Step::None) << "on its way";
    EXPECT_EQ(value.next(3), Step::Make);
    EXPECT_EQ(value.next(1), Step::Cancel) << "taken back";
    EXPECT_EQ(value.next(1), Step::None);
    EXPECT_EQ(value.next(3), Step::Make);
    value.giveUp();
    EXPECT_EQ(value.next(3), Step::Make) << "tried again";
    value.shown = 3;
    EXPECT_EQ(value.next(3), Step::None);
}

} // namespace
} // namespace tessera::app
