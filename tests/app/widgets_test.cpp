#include "app/pane/view_parts.h"
#include "app/ui/commands.h"
#include "app/ui/dock.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/theme.h"
#include "tests/app/cell_info.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"
#include "vis/scene/selection.h"

#include <gmock/gmock.h>

/// Parts of the window under the mouse: the palette of commands, lists of parameters, floating panes.
namespace tessera::app {
namespace {

using testing::Contains;
using testing::Not;

class Widgets : public FedImGui {
protected:
    Widgets() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    static ImVec2 placeOf(const std::string& text) {
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) return each.middle();
        ADD_FAILURE() << "not drawn: " << text;
        return {};
    }
};

TEST_F(Widgets, ThePaletteSaysWhatACommandDoesAndWhatItNeeds) {
    std::vector<Command> commands(3);
    commands[0] = {.menu = "File", .name = "Open", .help = "Open a file", .shortcut = {.key = 'O', .ctrl = true}};
    commands[1] = {.menu = "File", .name = "Export", .help = "Write a table"};
    commands[2] = {.menu = "File", .name = "Clear", .help = "Remove brushes"};
    for (Command& command : commands) command.run = [] {};
    for (const std::size_t i : {1, 2}) commands[i].enabled = [] { return false; };
    commands[1].needs = "data";
    CommandPalette palette;
    palette.open = true;
    const Command* chosen = nullptr;
    const auto draw = [&] { chosen = drawPalette(palette, commands); };
    const auto told = [&](const std::string& text) {
        mouse = placeOf(text);
        frames(3, draw);
        return drawnWords();
    };
    frames(4, draw);
    EXPECT_THAT(told("File: Open"), Contains("Open a file"));
    EXPECT_THAT(drawnWords(), Contains("Ctrl+O"));
    const auto needing = told("File: Export");
    EXPECT_THAT(needing, Contains("Write a table"));
    EXPECT_THAT(needing, Contains("Not now: it needs data"));
    EXPECT_THAT(told("File: Clear"), Contains("Remove brushes (not possible now)"));
    EXPECT_EQ(chosen, nullptr);
    mouse = placeOf("File: Open");
    feed(draw);
    for (const bool down : {true, false}) {
        ImGui::GetIO().MouseDown[0] = down;
        feed(draw);
        if (chosen) break;
    }
    EXPECT_EQ(chosen, &commands[0]);
}

TEST_F(Widgets, AListOfParametersIsReadAndChosenFrom) {
    const volume::DatasetInfo info = cellInfo();
    std::vector<std::string> values;
    const FieldInfo channels{.key = "channels", .doc = "help", .refersTo = "channel"};
    const FieldInfo others{"others", "help"};
    const FieldInfo* field = &channels;
    bool changed = false;
    const auto draw = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 300});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        changed = drawTexts({.info = &info}, *field, values) || changed;
        ImGui::End();
    };
    frames(3, draw);
    EXPECT_THAT(drawnWords(), Contains("all"));
    click(placeOf("all"), draw);
    click(placeOf("H2"), draw);
    EXPECT_TRUE(changed);
    EXPECT_EQ(values, std::vector<std::string>{"H2"});
    click(placeOf("T"), draw);
    EXPECT_EQ(values, (std::vector<std::string>{"H2", "T"}));
    EXPECT_THAT(drawnWords(), Contains("H2, T"));
    click(placeOf("all"), draw);
    EXPECT_TRUE(values.empty());
    values = {"a", "b"};
    field = &others;
    frames(2, draw);
    EXPECT_THAT(drawnWords(), Contains("2")) << "what cannot be chosen from is counted";
    EXPECT_THAT(drawnWords(), Not(Contains("a, b")));
}

TEST_F(Widgets, PlacesInTheDataFitTheirPaneInAHandyUnit) {
    volume::DatasetInfo info;
    info.bounds = {{0, 0, 0}, {0.0011, 0.0012, 0.04}};
    vis::SphereRegion ball{.center = {0.000512345, 0.000612345, 0.0123456}, .radius = glm::dvec3(0.00112345)};
    const vis::SphereRegion before = ball;
    float width = 500;
    const auto draw = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({width, 400});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        drawDescribed(ball, {.info = &info});
        ImGui::End();
    };
    const auto numbers = [&] {
        mouse = {-1000, -1000};
        frames(3, draw);
        std::vector<DrawnText> all;
        for (const DrawnText& text : drawnTexts())
            if (text.text.find_first_of("0123456789") != std::string::npos) all.push_back(text);
        return all;
    };
    using testing::StartsWith;
    for (width = 700; width > 120; width -= 20) {
        const std::vector<DrawnText> all = numbers();
        ASSERT_EQ(all.size(), 7u) << width << ": three of the centre, three radii, and the soft edge";
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            EXPECT_LT(all[i].max.x, width) << width;
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_TRUE(all[i].min.x > all[k].max.x || all[i].min.y > all[k].max.y) << width << ' ' << all[i].text;
        }
        EXPECT_THAT(all[2].text, StartsWith("12")) << width;
    }
    width = 700;
    EXPECT_EQ(numbers()[2].text, "12.35 mm");
    EXPECT_THAT(drawnWords(), Contains("Centre"));
    width = 300;
    const DrawnText last = numbers()[2];
    EXPECT_EQ(last.text, "12.3");
    EXPECT_THAT(drawnWords(), Contains("Centre [mm]")) << "the unit stands in the label where the numbers have none";
    EXPECT_EQ(ball, before) << "looking changes nothing";
    mouse = last.middle();
    frames(3, draw);
    EXPECT_THAT(drawnWords(), Contains("0.5123 mm, 0.6123 mm, 12.35 mm")) << "the whole under the mouse";
    // What is dragged alone changes, in the unit of the data.
    ImGui::GetIO().MouseDown[0] = true;
    frames(2, draw);
    mouse.x += 20;
    frames(2, draw);
    ImGui::GetIO().MouseDown[0] = false;
    frames(2, draw);
    EXPECT_EQ(ball.center.x, before.center.x);
    EXPECT_EQ(ball.center.y, before.center.y);
    EXPECT_GT(ball.center.z, before.center.z);
    EXPECT_LT(ball.center.z, 0.02);
    info.lengthUnit = "km"; // one that is not known stays
    width = 700;
    EXPECT_THAT(numbers()[0].text, testing::EndsWith(" km"));
}

TEST_F(Widgets, AFloatingPaneStaysWhereItIsPut) {
    DockTree tree;
    repair(tree, {"a", "b"});
    floatPane(tree, "b", {"b", 0.25f, 0.25f, 0.5f, 0.5f});
    DockController hand;
    DockPanes panes;
    ImVec2 at, size, padding;
    panes.title = [](const std::string& pane) { return "pane " + pane; };
    panes.padded = [](const std::string& pane) { return pane != "b"; };
    panes.draw = [&](const std::string& pane) {
        if (pane != "b") return;
        at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
        padding = {ImGui::GetCursorScreenPos().x - at.x, ImGui::GetCursorScreenPos().y - at.y};
    };
    panes.close = [&](const std::string& pane) { removePane(tree, pane); };
    const ImGuiStyle style = ImGui::GetStyle();
    const auto draw = [&] {
        drawDock(tree, hand, panes, {0, 0}, {800, 600}, 1);
        EXPECT_EQ(ImGui::GetStyle().WindowMinSize.x, style.WindowMinSize.x) << "nothing else is styled by it";
        EXPECT_EQ(ImGui::GetStyle().WindowPadding.x, style.WindowPadding.x);
    };
    frames(3, draw);
    EXPECT_EQ(at.x, 200);
    EXPECT_EQ(at.y, 150);
    EXPECT_EQ(size.x, 400);
    EXPECT_EQ(size.y, 300);
    EXPECT_EQ(padding.x, 0) << "a picture fills its pane";
    const ImVec2 title = placeOf("pane b");
    mouse = title;
    frames(2, draw);
    ImGui::GetIO().MouseDown[0] = true;
    feed(draw);
    mouse = {title.x + 80, title.y - 60};
    frames(3, draw);
    ImGui::GetIO().MouseDown[0] = false;
    frames(2, draw);
    ASSERT_EQ(tree.floating.size(), 1u);
    EXPECT_NEAR(tree.floating[0].x, 0.35f, 1e-3f);
    EXPECT_NEAR(tree.floating[0].y, 0.15f, 1e-3f);
    EXPECT_NEAR(tree.floating[0].width, 0.5f, 1e-3f);
    EXPECT_EQ(at.x, 280);
    EXPECT_EQ(at.y, 90);
}

TEST_F(Widgets, PanesAreClosedMaximisedFloatedAndDockedByTheirTitles) {
    DockTree tree;
    repair(tree, {"a", "b", "c"});
    DockController hand;
    DockPanes panes;
    std::vector<std::string> closed;
    panes.title = [](const std::string& pane) { return "pane " + pane; };
    panes.draw = [](const std::string&) {};
    panes.close = [&](const std::string& pane) {
        closed.push_back(pane);
        removePane(tree, pane);
    };
    const auto draw = [&] { drawDock(tree, hand, panes, {0, 0}, {800, 600}, 1); };
    frames(3, draw);
    const auto clickOn = [&](ImVec2 at, int button = 0, int times = 1) {
        mouse = at;
        frames(2, draw);
        for (int i = 0; i < times; ++i)
            for (const bool down : {true, false}) {
                ImGui::GetIO().MouseDown[button] = down;
                feed(draw);
            }
        frames(3, draw);
        mouse = {700, 500};
        feed(draw, 1); // the next click is none of a double click
        frames(2, draw);
    };
    const auto choose = [&](const std::string& title, const std::string& item) {
        mouse = placeOf(title);
        frames(2, draw);
        for (const bool down : {true, false}) {
            ImGui::GetIO().MouseDown[1] = down;
            feed(draw);
        }
        frames(3, draw);
        clickOn(placeOf(item));
    };
    clickOn(placeOf("pane b"));
    EXPECT_EQ(tree.root.active, 1) << "a click brings it to the front";
    clickOn(placeOf("pane b"), 0, 2);
    EXPECT_EQ(tree.maximised, "b");
    clickOn(placeOf("pane b"), 0, 2);
    EXPECT_EQ(tree.maximised, "");
    choose("pane b", "Maximise");
    EXPECT_EQ(tree.maximised, "b");
    choose("pane b", "Restore");
    EXPECT_EQ(tree.maximised, "");
    choose("pane b", "Float");
    ASSERT_EQ(tree.floating.size(), 1u);
    EXPECT_EQ(tree.floating[0].pane, "b");
    clickOn(placeOf("pane b"), 0, 2);
    EXPECT_TRUE(tree.floating.empty()) << "a double click docks it";
    EXPECT_EQ(panesOf(tree).size(), 3u);
    choose("pane b", "Float");
    choose("pane b", "Dock");
    EXPECT_TRUE(tree.floating.empty());
    choose("pane c", "Close");
    EXPECT_EQ(closed, std::vector<std::string>{"c"});
    EXPECT_EQ(panesOf(tree).size(), 2u);
}

TEST_F(Widgets, HeadsOfNumbersEndWhereTheNumbersEnd) {
    const auto draw = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({500, 200});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        if (ImGui::BeginTable("table", 3)) {
            for (int i = 0; i < 3; ++i) ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 120);
            tableHeader({"Name", "Mean", "Range"}, 1);
            ImGui::TableNextRow();
            for (const char* text : {"T", "300.25", "12"}) {
                ImGui::TableNextColumn();
                text[0] == 'T' ? ImGui::TextUnformatted(text) : textRight(text);
            }
            ImGui::EndTable();
        }
        ImGui::End();
    };
    frames(3, draw);
    const auto find = [](const char* wanted) {
        for (const DrawnText& each : drawnTexts())
            if (each.text == wanted) return each;
        ADD_FAILURE() << wanted;
        return DrawnText{};
    };
    EXPECT_NEAR(find("Mean").max.x, find("300.25").max.x, 2);
    EXPECT_NEAR(find("Range").max.x, find("12").max.x, 2);
    EXPECT_NEAR(find("Name").min.x, find("T").min.x, 2) << "names are at the left";
    EXPECT_GT(find("Mean").min.x, find("Name").min.x + 150);
}

// At the width of the number nothing else fits its line; at any width its groups stay together.
TEST_F(Widgets, NumbersOfSeveralGroupsDoNotBreak) {
    frames(1, [] {
        const std::string text = "11 x 13 = 14 443 001 samples\n7 a";
        const float number = ImGui::CalcTextSize(" 14 443 001").x;
        EXPECT_THAT(wrappedAtSpaces(text, number), testing::HasSubstr("\n14 443 001\nsamples"));
        for (float width = 1; width < 400; width += 3) {
            const std::string wrapped = wrappedAtSpaces(text, width);
            EXPECT_THAT(wrapped, testing::HasSubstr("14 443 001")) << width;
            EXPECT_THAT(wrapped, testing::HasSubstr("samples\n7")) << width;
        }
        EXPECT_EQ(wrappedAtSpaces(text, 1000), text);
        EXPECT_EQ(wrappedAtSpaces("\n 1 ", 1000), "\n 1 ");
    });
}

} // namespace
} // namespace tessera::app
