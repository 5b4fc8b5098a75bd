#include "app/edits/open_worth.h"
#include "app/pane/view_parts.h"
#include "app/views/worth/worth_data.h"
#include "tests/app/hands_fixture.h"

/// The mouse in the list of what is worth seeing.
namespace tessera::app {
namespace {

class WorthHands : public Hands {};

TEST_F(WorthHands, AClickOpensTheViewAsOneStep) {
    WorthSeeingView all; // of formulas without events
    all.falseDiscoveries = 0.5f;
    show(all, {520, 460});
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
