#include "app/history/history.h"
#include "app/history/parameter_path.h"
#include "app/ui/commands.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"
#include "tests/app/drawn_text.h"
#include "tests/app/ui_fixture.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>

namespace tessera::app {
namespace {

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
    const auto all = [&] {
        openSection("group Values along rays");
        drawDescribed(layer, {});
    };
    const auto threshold = [&] { drawParameter(session, "/layers/0/technique/threshold", {}); };
    const long composite = height(all); // classification and shading, no threshold
    EXPECT_EQ(height(threshold), 1);
    layer.quantity = vis::Quantity::Gradient;
    EXPECT_EQ(height(all), composite - 1) << "no classification";
    layer.style = vis::RayStyle::LocalMaximum;
    EXPECT_EQ(height(all), composite - 2) << "no shading and look, but a threshold";
    EXPECT_EQ(height(threshold), 1);
}

/// A struct with members that matter first and others in two groups, which do not lie together.
struct GroupedSettings {
    bool seldom = false, often = false, rarely = false, never = false, seldomToo = false, unused = false;
    static void describe(auto& self, auto&& visit) {
        visit(self.seldom, FieldInfo{.key = "seldom", .doc = "", .group = "Some"});
        visit(self.often, FieldInfo{"often", ""});
        visit(self.rarely, FieldInfo{.key = "rarely", .doc = "", .group = "Others"});
        visit(self.never, FieldInfo{.key = "never", .doc = "", .applies = false, .group = "None"});
        visit(self.seldomToo, FieldInfo{.key = "seldomToo", .doc = "", .group = "Some"});
        visit(self.unused, FieldInfo{.key = "unused", .doc = "", .hidden = true, .group = "None"});
    }
};

TEST_F(UiTest, GroupsFoldBelowTheMembersThatMatter) {
    GroupedSettings settings;
    std::vector<std::string> own, unfolds;
    const auto body = [&] {
        ImGui::SetNextWindowSize({400, 500});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration);
        for (const std::string& group : unfolds) openSection(("group " + group).c_str());
        drawMembers(valueOf(settings), {}, [&](Value, const FieldInfo& field) {
            own.emplace_back(field.key);
            return false;
        });
        ImGui::End();
    };
    const auto drawn = [&] {
        for (int i = 0; i < 2; ++i) {
            own.clear();
            frame(body);
        }
        std::vector<std::string> texts;
        for (const DrawnText& text : drawnTexts()) texts.push_back(text.text);
        return texts;
    };
    using testing::ElementsAre;
    EXPECT_THAT(drawn(), ElementsAre("Often", "Some", "Others"));
    EXPECT_THAT(own, ElementsAre("often")) << "what is folded is not asked for";
    unfolds = {"Some"};
    EXPECT_THAT(drawn(), ElementsAre("Often", "Some", "Seldom", "Seldom too", "Others"));
    unfolds = {"Others"}; // the other one stays as it is
    EXPECT_THAT(drawn(), ElementsAre("Often", "Some", "Seldom", "Seldom too", "Others", "Rarely"));
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
    const FieldInfo limited{.key = "gain", .doc = "", .range = Range{0, 1}};
    const FieldInfo free{.key = "place", .doc = "", .unit = "m"};
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

/// Places and times have the unit that the data state, or none.
TEST_F(UiTest, PlacesAndTimesHaveTheUnitsOfTheData) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), glm::dvec3(4)};
    const auto texts = [&](const char* length, const char* time) {
        info.lengthUnit = length;
        info.timeUnit = time;
        Session session;
        session.layers = {{"one", true, vis::VolumeLayer{}}};
        session.layers[0].timeShift = 1.5;
        session.lenses = {vis::Lens{.name = "lens", .center = {1, 2, 3}}};
        const auto body = [&] {
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({700, 200});
            ImGui::Begin("test");
            drawParameter(session, "/layers/0/timeShift", {.info = &info});
            drawParameter(session, "/lenses/0/center", {.info = &info});
            ImGui::End();
        };
        for (int i = 0; i < 3; ++i) frame(body);
        std::string all;
        for (const DrawnText& text : drawnTexts()) all += text.text + "\n";
        return all;
    };
    EXPECT_EQ(texts("cm", "h"), "test\nTime shift\n1.5 h\nCentre\n1 cm\n2 cm\n3 cm\n");
    EXPECT_EQ(texts("", ""), "test\nTime shift\n1.5\nCentre\n1\n2\n3\n");
}

TEST_F(UiTest, ADoubleClickTypesANumber) {
    const FieldInfo limited{.key = "gain", .doc = "", .range = Range{0, 1}};
    const FieldInfo free{.key = "place", .doc = "", .unit = "m"};
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
    const FieldInfo info{.key = "gain", .doc = "", .range = Range{0, 1}};
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

} // namespace
} // namespace tessera::app
