#include "app/ui/messages.h"

#include <gtest/gtest.h>
#include <limits>

namespace tessera::app {
namespace {

struct MessagesTest : testing::Test {
    double now = 0;
    Messages messages{[this] { return now; }};

    std::vector<std::string> news() {
        std::vector<std::string> texts;
        for (const Messages::Message* each : messages.news()) texts.push_back(each->text);
        return texts;
    }
};

using Texts = std::vector<std::string>;

TEST_F(MessagesTest, TheNewestThreeStandInTheStatusLine) {
    for (const char* text : {"a", "b", "c", "d"}) messages.add(text);
    EXPECT_EQ(news(), (Texts{"d", "c", "b"}));
    messages.news().front()->gone = true;
    EXPECT_EQ(news(), (Texts{"c", "b"})) << "what was too much does not come back";
    EXPECT_EQ(messages.list().size(), 4u);
    EXPECT_EQ(messages.list().front().clock.size(), 8u) << "hours, minutes, seconds";
}

TEST_F(MessagesTest, FailuresStandLonger) {
    EXPECT_EQ(messages.secondsToChange(), std::numeric_limits<double>::infinity());
    messages.add("failed", true);
    messages.add("done");
    EXPECT_DOUBLE_EQ(messages.secondsToChange(), 7);
    now = 8;
    EXPECT_EQ(news(), (Texts{"failed"}));
    EXPECT_DOUBLE_EQ(messages.secondsToChange(), 22);
    now = 31;
    EXPECT_EQ(news(), Texts{});
    EXPECT_EQ(messages.secondsToChange(), std::numeric_limits<double>::infinity());
}

TEST_F(MessagesTest, WhatIsSetAsideLeavesTheStatusLineAlone) {
    messages.add("of the former data", true);
    messages.setAside();
    messages.add("new");
    EXPECT_EQ(news(), Texts{"new"});
    EXPECT_EQ(messages.list().size(), 2u) << "the pane keeps it";
}

TEST_F(MessagesTest, TheOldestAreForgotten) {
    for (std::size_t i = 0; i < Messages::kKept + 1; ++i) messages.add(std::to_string(i));
    EXPECT_EQ(messages.list().size(), Messages::kKept);
    EXPECT_EQ(messages.list().front().text, "1");
}

} // namespace
} // namespace tessera::app
