#include "app/edits/open_worth.h"
#include "app/pane/view_parts.h"
#include "app/views/worth/worth_data.h"
#include "tests/app/hands_fixture.h"
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

} // namespace
} // namespace tessera::app
