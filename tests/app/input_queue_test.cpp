#include "app/platform/input_queue.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(InputQueueTest, ATapWithinOneFrameIsSeenAsDownAndUp) {
    InputQueue queue;
    std::vector<std::pair<int, bool>> keys;
    const auto take = [&] {
        keys.clear();
        queue.take([&](const InputQueue::Event& event) { keys.emplace_back(event.code, event.down); });
    };
    using Event = InputQueue::Event;
    // Control may be released before or after the letter.
    for (const auto& [code, down] : {std::pair{341, true}, {int('S'), true}, {341, false}, {int('S'), false}})
        queue.add({.kind = Event::Key, .code = code, .down = down});
    take();
    EXPECT_EQ(keys, (std::vector<std::pair<int, bool>>{{341, true}, {'S', true}}));
    take();
    EXPECT_EQ(keys, (std::vector<std::pair<int, bool>>{{341, false}, {'S', false}}));
    EXPECT_TRUE(queue.empty());
}

TEST(InputQueueTest, WhatIsTypedIntoAFieldFitsAFrameAndKeepsItsOrder) {
    InputQueue queue;
    using Event = InputQueue::Event;
    // Ctrl+A, then "aa", then Enter: the letters come after what they replace and before what ends them.
    for (const auto& [code, down, mods] : {std::tuple{341, true, 2}, {int('A'), true, 2}, {int('A'), false, 2}})
        queue.add({.kind = Event::Key, .code = code, .mods = mods, .down = down});
    queue.add({.kind = Event::Key, .code = 341, .mods = 0, .down = false});
    for (int i = 0; i < 2; ++i) {
        queue.add({.kind = Event::Key, .code = 'A', .down = true});
        queue.add({.kind = Event::Letter, .code = 'a'});
        queue.add({.kind = Event::Key, .code = 'A', .down = false});
    }
    queue.add({.kind = Event::Key, .code = 257, .down = true});
    std::vector<std::string> frames;
    while (!queue.empty() && frames.size() < 20) {
        std::string seen;
        queue.take(
            [&](const Event& event) {
                if (event.kind == Event::Letter) seen += char(event.code);
                if (event.kind == Event::Key && event.down && event.code == 257) seen += '!';
                if (event.kind == Event::Key && event.down && (event.mods & 2) && event.code == 'A') seen += '*';
            },
            true);
        if (!seen.empty()) frames.push_back(seen);
    }
    EXPECT_EQ(frames, (std::vector<std::string>{"*", "aa!"}));
}

TEST(InputQueueTest, ADragBeginsWhereTheButtonWentDown) {
    InputQueue queue;
    using Event = InputQueue::Event;
    const auto none = [](const Event&) {};
    queue.add({.kind = Event::Move, .at = {10, 10}});
    queue.add({.kind = Event::Button, .down = true});
    queue.add({.kind = Event::Move, .at = {50, 50}});
    queue.add({.kind = Event::Move, .at = {90, 90}});
    queue.add({.kind = Event::Button, .down = false});
    const auto expect = [&](bool down, float x) {
        queue.take(none);
        EXPECT_EQ(queue.buttons[0], down);
        EXPECT_EQ(queue.mouse.x, x);
    };
    expect(false, 10);
    expect(true, 10);
    expect(true, 90); // a frame with the button still held at the end of the drag
    expect(false, 90);
    EXPECT_TRUE(queue.empty());
}

TEST(InputQueueTest, TwoPressesAreADoubleClickByWhenTheyCame) {
    InputQueue queue;
    using Event = InputQueue::Event;
    std::vector<bool> twice;
    const auto click = [&](int button, double time) {
        queue.add({.kind = Event::Button, .code = button, .down = true, .time = time});
        queue.add({.kind = Event::Button, .code = button, .down = false, .time = time + 0.05});
    };
    for (const double time : {10.0, 10.2, 11.0}) click(0, time);
    click(1, 11.1);
    click(7, 11.1); // one that the program has no use for
    while (!queue.empty()) {
        queue.take([](const Event&) {});
        if (queue.buttons[0] || queue.buttons[1]) twice.push_back(queue.twice);
    }
    EXPECT_EQ(twice, (std::vector<bool>{false, true, false, false}));
}

// Alt and the wheel over a lens would else zoom the picture where frames are slow.
TEST(InputQueueTest, TheWheelTurnsWhereTheMouseWasWithTheKeysThatWereHeld) {
    InputQueue queue;
    using Event = InputQueue::Event;
    const auto none = [](const Event&) {};
    queue.add({.kind = Event::Key, .code = 342, .down = true});
    queue.add({.kind = Event::Move, .at = {10, 10}});
    for (int i = 0; i < 3; ++i) queue.add({.kind = Event::Wheel, .at = {0, 1}});
    queue.add({.kind = Event::Key, .code = 342, .down = false});
    queue.add({.kind = Event::Wheel, .at = {0.5f, -1}});
    queue.add({.kind = Event::Move, .at = {90, 90}});
    queue.add({.kind = Event::Button, .down = true});
    const auto expect = [&](float turned, bool alt, float x, bool down) {
        queue.take(none);
        EXPECT_EQ(queue.wheel.y, turned);
        EXPECT_EQ(queue.held(InputQueue::kAlt), alt);
        EXPECT_EQ(queue.mouse.x, x);
        EXPECT_EQ(queue.buttons[0], down);
    };
    expect(3, true, 10, false);
    expect(-1, false, 10, false);
    expect(0, false, 90, false);
    expect(0, false, 90, true);
    EXPECT_TRUE(queue.empty());
}

} // namespace
} // namespace tessera::app
