#include "app/history/history.h"
#include "app/history/parameter_path.h"
#include "app/platform/input_queue.h"
#include "app/ui/commands.h"
#include "app/ui/dock.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"
#include "tests/app/drawn_text.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <imgui.h>
#include <random>
#include <set>

namespace tessera::app {
namespace {

/// ImGui without a GPU: frames of 800 x 600 with a mouse and keys that the test holds.
class UiTest : public ::testing::Test {
protected:
    void SetUp() override {
        context = ImGui::CreateContext();
        ImGui::SetCurrentContext(context);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {800, 600};
        setUpKeys(io);
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
        unsigned char* pixels = nullptr;
        int w = 0, h = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &w, &h);
    }
    void TearDown() override { ImGui::DestroyContext(context); }

    template <class Body> void frame(Body&& body) {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 1.0f / 60;
        io.MousePos = mouse;
        io.MouseDown[0] = held;
        ImGui::NewFrame();
        body();
        ImGui::Render();
    }

    ImGuiContext* context = nullptr;
    ImVec2 mouse{-1, -1};
    bool held = false;
};

TEST_F(UiTest, DraggingASliderIsOneUndoStep) {
    Session session;
    History history;
    history.reset(session);
    ImVec2 slider;
    int changes = 0, commits = 0;
    double seconds = 0;
    const auto body = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 500});
        ImGui::Begin("test");
        slider = {300, ImGui::GetCursorScreenPos().y + ImGui::GetFrameHeight() / 2};
        const WidgetContext widgets;
        if (drawDescribed(session.appearance, widgets)) ++changes;
        ImGui::End();
        seconds += 1.0 / 60;
        if (history.observe(session, ImGui::IsAnyItemActive() || held, seconds)) ++commits;
    };
    for (int i = 0; i < 3; ++i) frame(body);
    // The second row of Appearance is the scale.
    mouse = {slider.x, slider.y + ImGui::GetFrameHeightWithSpacing()};
    frame(body);
    held = true;
    for (int i = 0; i < 25; ++i) {
        mouse.x += 3;
        frame(body);
    }
    EXPECT_EQ(commits, 0) << "an edit was kept before it ended";
    held = false;
    for (int i = 0; i < 3; ++i) frame(body);
    EXPECT_GT(changes, 10);
    ASSERT_EQ(commits, 1);
    ASSERT_EQ(history.steps().size(), 1u);
    EXPECT_EQ(history.steps()[0].name, "look of the window: scale");
    EXPECT_GT(session.appearance.scale, 1);
    session = history.undo();
    EXPECT_EQ(session.appearance.scale, 1);
    session = history.redo();
    EXPECT_GT(session.appearance.scale, 1);
}

// A setting that the others leave without effect has no widget among them, but one where it is asked for by name.
TEST_F(UiTest, WhatDoesNotApplyIsNotDrawn) {
    Session session;
    session.layers = {{"volume", true, vis::VolumeLayer{.channel = "v"}}};
    auto& layer = std::get<vis::VolumeLayer>(session.layers[0].technique);
    const auto height = [&](auto&& draw) {
        float rows = 0;
        const auto body = [&] {
            ImGui::SetNextWindowSize({400, 500});
            ImGui::Begin("test");
            const float before = ImGui::GetCursorPosY();
            draw();
            rows = (ImGui::GetCursorPosY() - before) / ImGui::GetFrameHeightWithSpacing();
            ImGui::End();
        };
        for (int i = 0; i < 3; ++i) frame(body);
        return std::lround(rows);
    };
    const auto all = [&] { drawDescribed(layer, {}); };
    const auto threshold = [&] { drawParameter(session, "/layers/0/technique/threshold", {}); };
    const long composite = height(all); // classification and shading, no threshold
    EXPECT_EQ(height(threshold), 1);
    layer.quantity = vis::Quantity::Gradient;
    EXPECT_EQ(height(all), composite - 1) << "no classification";
    layer.style = vis::RayStyle::LocalMaximum;
    EXPECT_EQ(height(all), composite - 2) << "no shading and look, but a threshold";
    EXPECT_EQ(height(threshold), 1);
}

class DockTest : public UiTest {
protected:
    void SetUp() override {
        UiTest::SetUp();
        repair(tree, {"a", "b", "c"});
        panes.title = [](const std::string& pane) { return "pane " + pane; };
        panes.draw = [this](const std::string& pane) {
            drawn.insert(pane);
            ImGui::TextUnformatted(pane.c_str());
        };
        panes.close = [this](const std::string& pane) { removePane(tree, pane); };
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            drawn.clear();
            frame([&] { drawDock(tree, hand, panes, {0, 0}, {800, 600}, 1); });
        }
    }
    void drag(ImVec2 from, ImVec2 to) {
        mouse = from;
        step(2);
        held = true;
        step();
        for (int i = 1; i <= 10; ++i) {
            mouse = {from.x + (to.x - from.x) * float(i) / 10, from.y + (to.y - from.y) * float(i) / 10};
            step();
        }
        held = false;
        step(2);
    }
    DockTree tree;
    DockHand hand;
    DockPanes panes;
    std::set<std::string> drawn;
};

TEST_F(DockTest, OnlyThePaneInFrontIsDrawn) {
    step(2);
    EXPECT_EQ(drawn, std::set<std::string>{"a"});
}

TEST_F(DockTest, ATabIsDraggedToASideAndBack) {
    step(2);
    drag({20, 10}, {700, 300}); // tab a to the right edge of the stack
    ASSERT_EQ(tree.root.kind, DockKind::Row);
    EXPECT_EQ(tree.root.children[1].tabs, std::vector<std::string>{"a"});
    EXPECT_EQ(tree.root.children[0].tabs, (std::vector<std::string>{"b", "c"}));
    step(2);
    EXPECT_EQ(drawn, (std::set<std::string>{"b", "a"}));
    drag({420, 10}, {200, 300}); // and into the middle of the other one
    ASSERT_EQ(tree.root.kind, DockKind::Tabs);
    EXPECT_EQ(tree.root.tabs.back(), "a");
}

TEST_F(DockTest, EscapeEndsADrag) {
    step(2);
    mouse = {20, 10};
    step(2);
    held = true;
    step();
    mouse = {700, 300};
    step(2);
    feedKey(ImGui::GetIO(), key::kEscape, true);
    step();
    feedKey(ImGui::GetIO(), key::kEscape, false);
    held = false;
    step(2);
    EXPECT_EQ(tree.root.kind, DockKind::Tabs);
}

TEST_F(DockTest, ASplitterFollowsTheMouseInTheSameFrame) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    step(2);
    const float edge = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects.at(tree.root.children[0].id).hi.x;
    mouse = {edge + 2, 300};
    step(2);
    held = true;
    step();
    mouse.x += 200;
    step();
    EXPECT_EQ(layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects.at(tree.root.children[0].id).hi.x, edge + 200);
    mouse.x = 5000; // into the limit: the stored ratio is what is shown
    step();
    const auto rects = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects;
    const float shown = rects.at(tree.root.children[0].id).hi.x;
    EXPECT_NEAR(tree.root.ratio, shown / (800 - (rects.at(tree.root.children[1].id).lo.x - shown)), 1e-3);
    held = false;
    step();
}

TEST_F(DockTest, HiddenPanesTakeNoRoom) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    const DockTree before = tree;
    const int left = tree.root.children[0].id, right = tree.root.children[1].id;
    const DockRect whole{{0, 0}, {800, 600}};
    const auto hides = [](const std::string& name) { return [name](const std::string& pane) { return pane == name; }; };
    DockLayout layout = layoutDock(tree, whole, 1, hides("c"));
    EXPECT_EQ(layout.rects.at(left).hi.x, 800);
    EXPECT_FALSE(layout.rects.contains(right));
    EXPECT_TRUE(layout.splitters.empty());
    // One of several tabs: the stack stays, and shows another where that one was in front.
    layout = layoutDock(tree, whole, 1, hides("a"));
    EXPECT_EQ(layout.rects.size(), 2u);
    tree.root.children[0].active = 0;
    const ShownTabs shown = shownTabs(tree.root.children[0], hides("a"));
    EXPECT_EQ(shown.panes, (std::vector<std::string>{"b"}));
    EXPECT_EQ(shown.front, 0u);
    tree.root.children[0].active = before.root.children[0].active;
    EXPECT_TRUE(layoutDock(tree, whole, 1, [](const std::string&) { return true; }).rects.empty());
    EXPECT_TRUE(tree == before) << "it is only not shown";
}

TEST_F(DockTest, ASplitterUnderTheMouseIsLitAndNothingElse) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    step(2);
    const auto rects = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects;
    const float left = rects.at(tree.root.children[0].id).hi.x, right = rects.at(tree.root.children[1].id).lo.x;
    const auto lit = [] {
        std::vector<ImVec2> below; // the strips of tabs
        for (const ImVec2& corner : drawnIn(palette().accentSoft))
            if (corner.y > 500) below.push_back(corner);
        return below;
    };
    EXPECT_TRUE(lit().empty());
    mouse = {left + 2, 300};
    step(2);
    ASSERT_FALSE(lit().empty());
    for (const ImVec2& corner : lit()) {
        EXPECT_GE(corner.x, left - 1);
        EXPECT_LE(corner.x, right + 1);
    }
}

TEST_F(DockTest, RectanglesTileTheWindow) {
    std::mt19937 random(4);
    for (int i = 0; i < 200; ++i) {
        insertPane(tree, std::string(1, char('a' + i % 3)), 1 + int(random() % 6), static_cast<DockSide>(random() % 5));
        const ImVec2 size{float(50 + random() % 1900), float(50 + random() % 1100)};
        for (const auto& [id, rect] : layoutDock(tree, {{0, 0}, size}, 1).rects) {
            ASSERT_GE(rect.hi.x, rect.lo.x);
            ASSERT_GE(rect.hi.y, rect.lo.y);
            ASSERT_EQ(rect.lo.x, std::round(rect.lo.x));
            ASSERT_LE(rect.hi.x, size.x + 1);
            ASSERT_LE(rect.hi.y, size.y + 1);
        }
    }
}

TEST_F(DockTest, ARestlessHandLeavesAValidTree) {
    std::mt19937 random(9);
    for (int i = 0; i < 1500; ++i) {
        mouse = {float(random() % 900) - 50, float(random() % 700) - 50};
        if (random() % 4 == 0) mouse.y = float(random() % 26);
        held = random() % 3 != 0;
        if (random() % 150 == 0) tree.maximised = random() % 2 ? "a" : "";
        if (random() % 90 == 0) floatPane(tree, "b", {"b", 0.2f, 0.2f, 0.4f, 0.4f});
        if (panesOf(tree).size() < 3) repair(tree, {"a", "b", "c"});
        step();
        DockTree copy = tree;
        std::vector<std::string> all = panesOf(tree);
        repair(copy, all);
        ASSERT_TRUE(copy.root == tree.root) << i;
    }
}

TEST(CommandsTest, ThePaletteFindsByWordsAndLetters) {
    EXPECT_GT(matchScore("undo", "Edit: Undo"), matchScore("undo", "Edit: un do o"));
    EXPECT_GT(matchScore("sp", "File: Save picture"), 0);
    EXPECT_EQ(matchScore("xyz", "File: Save picture"), 0);
    EXPECT_GT(matchScore("", "anything"), 0);
    EXPECT_GT(matchScore("screenshot", "File: Save picture", "screenshot image"), kWholeWords);
    EXPECT_GT(matchScore("picture save", "File: Save picture"), kWholeWords) << "in any order";
    EXPECT_GT(matchScore("pict imag", "File: Save picture", "screenshot image"), kWholeWords);
    EXPECT_LT(matchScore("pict dark", "File: Save picture", "screenshot image"), kWholeWords);
    EXPECT_GT(matchScore("picture save", "Save picture"), matchScore("picture save", "New: Volume", "picture save"))
        << "its own words before others";
    EXPECT_EQ(matchScore("shot", "Save picture", "screenshot"), 0) << "words are found by their beginning";
    EXPECT_EQ(textOf({.key = 'P', .ctrl = true, .shift = true}), "Ctrl+Shift+P");
    EXPECT_EQ(textOf({.key = key::kF12}), "F12");
}

TEST(CommandsTest, WhatIsNotPossibleNowComesLastAndLettersOnlyWithoutWords) {
    const auto none = [] {};
    const std::vector<Command> commands{
        {.menu = "Edit", .name = "Undo", .help = "", .run = none, .enabled = [] { return false; }},
        {.menu = "View", .name = "New: History", .help = "", .words = "undo redo", .run = none},
        {.menu = "File", .name = "Unload old", .help = "", .run = none}};
    const auto found = [&](const char* typed) {
        std::vector<std::string> names;
        for (const Command* command : matchingCommands(typed, commands)) names.push_back(command->name);
        return names;
    };
    EXPECT_EQ(found("hist undo"), (std::vector<std::string>{"New: History"}));
    EXPECT_EQ(found("uod"), (std::vector<std::string>{"Unload old"}));
    EXPECT_EQ(found("").size(), 3u);
    EXPECT_EQ(found("").back(), "Undo");
}

// Enter runs the first: "add flow layer" without vectors opened another pane of layers.
TEST(CommandsTest, WhatIsTypedAsItIsComesFirstThoughItIsNotPossible) {
    const auto none = [] {};
    const std::vector<Command> commands{
        {.menu = "View", .name = "New: Layers", .help = "", .words = "add flow layer", .run = none},
        {.menu = "", .name = "Add flow layer", .help = "", .run = none, .enabled = [] { return false; }},
        {.menu = "", .name = "Add flow layer below", .help = "", .words = "", .run = none}};
    EXPECT_EQ(matchingCommands("add flow layer", {commands[0], commands[1]}).front()->name, "Add flow layer");
    EXPECT_EQ(matchingCommands("add flow layer", commands).front()->name, "Add flow layer below");
    EXPECT_EQ(matchingCommands("flow", {commands[0], commands[1]}).front()->name, "Add flow layer");
}

/// Draws a number in a window of its own; gives the middle of its field.
ImVec2 middleOfNumber(const FieldInfo& info, double& value) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({400, 100});
    ImGui::Begin("test");
    drawNumber({}, info, {}, &value, 1, false);
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    ImGui::End();
    return {(lo.x + hi.x) / 2, (lo.y + hi.y) / 2};
}

// Dear ImGui reads 1e999 as infinity, whose differences are not numbers.
TEST_F(UiTest, ATypedNumberIsFinite) {
    const FieldInfo limited{.key = "gain", .unit = "", .doc = "", .range = Range{0, 1}};
    const FieldInfo free{.key = "place", .unit = "m", .doc = ""};
    for (const FieldInfo& info : {limited, free}) {
        double value = 0.5;
        ImVec2 at;
        const auto body = [&] { at = middleOfNumber(info, value); };
        const auto type = [&](const char* text) {
            ImGuiIO& io = ImGui::GetIO();
            for (int i = 0; i < 2; ++i) frame(body);
            mouse = at;
            feedModifiers(io, true, false, false);
            for (const bool down : {false, true, false}) {
                held = down;
                frame(body);
            }
            feedModifiers(io, false, false, false);
            frame(body);
            io.AddInputCharactersUTF8(text);
            frame(body);
            for (const bool down : {true, false}) {
                feedKey(io, key::kEnter, down);
                frame(body);
            }
        };
        type("0.25");
        EXPECT_EQ(value, 0.25) << info.key;
        type("1e999");
        EXPECT_EQ(value, info.range ? 1 : 0.25) << info.key << ": a limit, or as before";
    }
}

TEST_F(UiTest, ADoubleClickTypesANumber) {
    const FieldInfo limited{.key = "gain", .unit = "", .doc = "", .range = Range{0, 1}};
    const FieldInfo free{.key = "place", .unit = "m", .doc = ""};
    for (const FieldInfo& info : {limited, free})
        for (const int clicks : {1, 2}) {
            double value = 0.5;
            ImVec2 at;
            const auto body = [&] { at = middleOfNumber(info, value); };
            for (int i = 0; i < 60; ++i) frame(body); // long after the clicks before
            mouse = at;
            for (int click = 0; click < clicks; ++click)
                for (const bool down : {false, true, false}) {
                    held = down;
                    frame(body);
                }
            EXPECT_EQ(ImGui::GetIO().WantTextInput, clicks == 2) << info.key;
            ImGui::GetIO().AddInputCharactersUTF8("0.25");
            for (const bool down : {true, false}) {
                frame(body);
                feedKey(ImGui::GetIO(), key::kEnter, down);
                frame(body);
            }
            EXPECT_EQ(std::abs(value - 0.25) < 1e-12, clicks == 2) << info.key << " by " << clicks;
            EXPECT_FALSE(ImGui::GetIO().KeyCtrl) << "no key is held";
        }
}

TEST_F(UiTest, EscAfterADoubleClickLeavesTheValueAsItWas) {
    const FieldInfo info{.key = "gain", .unit = "", .doc = "", .range = Range{0, 1}};
    double value = 0.125;
    ImVec2 at;
    const auto body = [&] { at = middleOfNumber(info, value); };
    const auto click = [&] {
        for (const bool down : {false, true, false}) {
            held = down;
            frame(body);
        }
    };
    for (int i = 0; i < 60; ++i) frame(body);
    mouse = at;
    click();
    EXPECT_NEAR(value, 0.5, 0.02) << "one click moves it";
    click();
    EXPECT_TRUE(ImGui::GetIO().WantTextInput);
    EXPECT_EQ(value, 0.125) << "what is typed over is the value before the first click";
    for (const bool down : {true, false}) {
        feedKey(ImGui::GetIO(), key::kEscape, down);
        frame(body);
    }
    frame(body);
    EXPECT_FALSE(ImGui::GetIO().WantTextInput);
    EXPECT_EQ(value, 0.125);
}

TEST_F(UiTest, AMenuHasRoomForTheListOfSettings) {
    Session session;
    std::string search, path;
    float width = 0;
    const auto body = [&] {
        ImGui::Begin("test");
        if (ImGui::GetFrameCount() == 2) ImGui::OpenPopup("menu");
        if (ImGui::BeginPopup("menu")) {
            chooseParameter("settings", session, parameterPaths(session), search, path);
            width = ImGui::GetWindowWidth();
            ImGui::EndPopup();
        }
        ImGui::End();
    };
    for (int i = 0; i < 6; ++i) frame(body);
    EXPECT_GT(width, ImGui::GetFontSize() * 15);
}

TEST_F(UiTest, ShortcutsNeedExactlyTheirModifiers) {
    int undone = 0, redone = 0;
    const std::vector<Command> commands = {
        {.menu = "", .name = "undo", .help = "", .shortcut = {.key = 'Z', .ctrl = true}, .run = [&] { ++undone; }},
        {.menu = "", .name = "redo", .help = "", .shortcut = {.key = 'Z', .ctrl = true, .shift = true}, .run = [&] {
             ++redone;
         }}};
    ImGuiIO& io = ImGui::GetIO();
    const auto tap = [&](bool shift) {
        feedModifiers(io, true, shift, false);
        feedKey(io, 'Z', true);
        frame([&] { runShortcuts(commands); });
        feedKey(io, 'Z', false);
        feedModifiers(io, false, false, false);
        frame([&] { runShortcuts(commands); });
    };
    tap(false);
    EXPECT_EQ(undone, 1);
    EXPECT_EQ(redone, 0);
    tap(true);
    EXPECT_EQ(undone, 1);
    EXPECT_EQ(redone, 1);
}

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
