#include "app/edits/open_worth.h"
#include "app/pane/view_parts.h"
#include "app/ui/time_text.h"
#include "app/views/worth/worth_data.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/views_fixture.h"
#include "volume/synthetic/models.h"

/// The mouse in the list of what is worth seeing.
namespace tessera::app {
namespace {

class WorthHands : public Hands {
protected:
    /// The list of the planted events, of the last time.
    void showPlanted() {
        Opened opened;
        opened.source = opened.numbers = volume::makeMemorySource(volume::makeModel("planted", {{"times", 3}}), {});
        DataRef data;
        data.model = "planted";
        opened.document.session = defaultSession(opened.source->info(), data);
        Session& session = opened.document.session;
        session.views = {{"pane", WorthSeeingView{}}};
        session.time = opened.source->info().times.back();
        repair(session.dock, paneKeys(session));
        opened.document.history.reset(session);
        workbench.install(std::move(opened));
        frames.emplace(glm::ivec2(520, 460));
        settle();
    }
};

TEST_F(WorthHands, AClickOpensTheViewAsOneStep) {
    showPlanted();
    const volume::DatasetInfo& info = workbench.numbers()->info();
    const WorthQuestion question =
        worthQuestion(session(), info, view<WorthSeeingView>(), chosenChannels(info, {}, 32));
    const volume::WorthFindings answer = readWorth(workbench.numbers(), question, 0);
    ASSERT_FALSE(answer.found.empty());
    Session expected = session();
    openFinding(expected, info, answer.found[0], question.time, "pane");
    const Session before = session();
    click(item(window("findings"), {1, "##row"}).GetCenter());
    settle();
    EXPECT_TRUE(session() == expected) << apart(expected);
    EXPECT_EQ(steps(), 1u);
    undo();
    settle();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(WorthHands, WithoutABrushWhatElseSaysWhatItNeeds) {
    WorthSeeingView view;
    view.list = WorthList::WhatElse;
    show(view, {520, 460});
    EXPECT_EQ(window("findings"), nullptr);
}

/// The list in a window of its own, which searches in the background.
class WorthScrub : public ViewsTest {
protected:
    void drawList(bool interacting) {
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.numbers = source;
            context.interacting = interacting;
            context.offerExport = [&](ViewExport made) { offered = std::move(made); };
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({520, 460});
            ImGui::Begin("view", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            drawWorthSeeingView(context, "view", list);
            ImGui::End();
        });
    }
    void search() {
        drawList(false);
        jobs.wait();
        jobs.collect();
        drawList(false);
    }
    std::string csv() const { return offered.table ? csvOf(offered.table({})) : std::string(); }

    WorthSeeingView list;
    ViewExport offered;
};

TEST_F(WorthScrub, AnOlderListSaysItsOwnTime) {
    show(volume::makeMemorySource(volume::makeModel("planted", {{"times", 3}}), {}));
    const std::vector<double>& times = source->info().times;
    const auto named = [&](double time) { return "at " + timeText(source->info(), time) + ", "; };
    session.time = times[2];
    search();
    const std::string before = csv();
    EXPECT_NE(before.find("worth seeing: " + named(times[2])), std::string::npos) << before;
    session.time = times[1];
    drawList(true); // a hand moves the time: no search is begun
    EXPECT_EQ(csv(), before);
    search();
    EXPECT_NE(csv().find("worth seeing: " + named(times[1])), std::string::npos) << csv();
}

} // namespace
} // namespace tessera::app
