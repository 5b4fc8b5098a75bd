#include "app/ui/number_field.h"

#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
#include <set>
#include <vector>

/// Fields of numbers under the mouse, with and without modifiers.
namespace tessera::app {
namespace {

class NumberField : public FedImGui {
protected:
    NumberField() : FedImGui({440, 300}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
        ImGui::GetIO().MouseDoubleClickTime = 0; // clicks on one place are clicks
    }

    static constexpr float kWidth = 400;
    double value = 0.3;
    NumberStyle style{.format = "%.4f", .range = Range{0, 1}, .span = 1};
    bool ctrl = false, shift = false, down = false;
    ImVec2 corner;

    void frame(float wheel = 0) {
        ImGuiIO& io = ImGui::GetIO();
        io.MouseDown[0] = down;
        io.MouseWheel = wheel;
        feedModifiers(io, ctrl, shift, false);
        feedWindow([&] {
            corner = ImGui::GetCursorScreenPos();
            ImGui::SetNextItemWidth(kWidth);
            numberFields("number", &value, 1, style);
        });
    }
    void moveTo(float x) {
        mouse = {corner.x + x, corner.y + 8};
        for (int i = 0; i < 2; ++i) frame();
    }
    void press() {
        down = true;
        frame();
    }
    void release() {
        down = false;
        for (int i = 0; i < 2; ++i) frame();
    }
    /// A drag from one place to another, a pixel at a time.
    void drag(float from, float to) {
        moveTo(from);
        press();
        const float step = to > from ? 1.0f : -1.0f;
        for (float x = from; std::abs(x - to) > 0.5f; x += step) mouse.x += step, frame();
    }
};

TEST_F(NumberField, ASliderGoesToTheMouse) {
    frame();
    drag(300, 200);
    EXPECT_NEAR(value, 0.5, 0.02);
    release();
    EXPECT_NEAR(value, 0.5, 0.02);
}

TEST_F(NumberField, WithShiftADragIsATenthAsFarFromWhereTheNumberIs) {
    frame();
    shift = true;
    drag(300, 200);
    EXPECT_NEAR(value, 0.3 - 0.1 * 100 / double(kWidth), 0.002);
    shift = false; // goes on from there
    const double before = value;
    for (int i = 0; i < 40; ++i) mouse.x += 1, frame();
    EXPECT_NEAR(value, before + 40 / double(kWidth), 0.005);
    const double after = value;
    release();
    EXPECT_EQ(value, after);
    // Without limits.
    style.range.reset();
    double moved[2] = {};
    for (const bool fine : {false, true}) {
        value = 0.3;
        shift = fine;
        drag(100, 200);
        release();
        moved[fine] = value - 0.3;
    }
    EXPECT_GT(moved[0], 0.1);
    EXPECT_NEAR(moved[1], 0.1 * moved[0], 0.02 * moved[0]);
}

TEST_F(NumberField, WithCtrlADragSnaps) {
    frame();
    for (const bool limited : {true, false}) {
        style.range = limited ? std::optional(Range{0, 1}) : std::nullopt;
        value = 0.3;
        drag(130, 233);
        ctrl = true;
        const double loose = value;
        std::vector<double> seen;
        for (int i = 0; i < 60; ++i) {
            mouse.x += 1;
            frame();
            EXPECT_NEAR(value / 0.02, std::round(value / 0.02), 1e-9) << "a fiftieth of the span";
            seen.push_back(value);
        }
        EXPECT_GT(std::set<double>(seen.begin(), seen.end()).size(), 5u) << "small ways add up";
        EXPECT_GT(value, loose + 0.1);
        char text[16];
        std::snprintf(text, sizeof text, "%.4f", value);
        EXPECT_THAT(drawnWords(), testing::Contains(text)) << "what is shown is the number";
        const double snapped = value;
        ctrl = false; // in the frame of the button
        release();
        EXPECT_EQ(value, snapped) << limited;
    }
}

TEST_F(NumberField, CtrlAndTheWheelStep) {
    frame();
    moveTo(200);
    frame(1);
    EXPECT_EQ(value, 0.3) << "the wheel alone scrolls the pane";
    ctrl = true;
    frame(1);
    EXPECT_NEAR(value, 0.32, 1e-12);
    frame(-3);
    EXPECT_NEAR(value, 0.26, 1e-12);
    shift = true;
    frame(1);
    EXPECT_NEAR(value, 0.262, 1e-12);
    frame(-1000);
    EXPECT_EQ(value, 0) << "up to the end";
    shift = false;
    value = 7;
    style = {.format = "%.0f", .range = Range{0, 20}, .span = 20, .integer = true};
    frame(1);
    EXPECT_EQ(value, 8);
    mouse.y += 100;
    frame();
    frame(1);
    EXPECT_EQ(value, 8) << "another place";
}

TEST_F(NumberField, WhatIsTypedIntoASliderStaysBetweenItsEnds) {
    float part = 30;
    int planes = 4;
    const auto both = [&] {
        ImGui::GetIO().MouseDown[0] = down;
        feedModifiers(ImGui::GetIO(), ctrl, false, false);
        feedWindow([&] {
            corner = ImGui::GetCursorScreenPos();
            ImGui::SetNextItemWidth(kWidth);
            slider("part", part, 0, 100, "%.1f");
            ImGui::SetNextItemWidth(kWidth);
            slider("planes", planes, 1, 12, "%d");
        });
    };
    const auto type = [&](float below, const char* text) {
        mouse = {corner.x + 50, corner.y + 8 + below};
        ctrl = true;
        for (const bool isDown : {false, true, false}) down = isDown, both();
        ctrl = false;
        both();
        ImGui::GetIO().AddInputCharactersUTF8(text);
        both();
        mouse = {corner.x, corner.y + 200}; // a click elsewhere ends it
        for (const bool isDown : {true, false}) down = isDown, both();
    };
    both();
    const float next = ImGui::GetFrameHeightWithSpacing();
    type(0, "42");
    EXPECT_EQ(part, 42) << "it is typed";
    type(0, "-6.25");
    EXPECT_EQ(part, 0);
    type(0, "1e9");
    EXPECT_EQ(part, 100);
    type(next, "7");
    EXPECT_EQ(planes, 7);
    type(next, "500");
    EXPECT_EQ(planes, 12);
}

TEST_F(NumberField, ADoubleClickTypesAndTakesBackTheFirst) {
    ImGui::GetIO().MouseDoubleClickTime = 0.5f;
    frame();
    moveTo(300);
    for (int i = 0; i < 2; ++i) {
        press();
        down = false;
        frame();
    }
    EXPECT_NEAR(value, 0.3, 1e-4);
    for (const char c : {'0', '.', '7'}) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
    frame();
    mouse = {corner.x, corner.y + 200};
    press();
    release();
    EXPECT_EQ(value, 0.7);
}

TEST(SnappedNumber, IsRound) {
    NumberStyle style{.format = "%.4f", .range = Range{0, 1}, .span = 1};
    EXPECT_EQ(snappedNumber(0.3047, style), 0.3);
    EXPECT_EQ(snappedNumber(0.999, style), 1);
    style.range = Range{0, 0.995};
    EXPECT_EQ(snappedNumber(0.999, style), 0.995) << "within the range";
    style = {.format = "%.0f", .range = std::nullopt, .span = 12345};
    EXPECT_EQ(snappedNumber(1777, style), 2000);
    style = {.format = "%.4g", .range = Range{1e-3, 1e3}, .span = 999, .logScale = true};
    EXPECT_NEAR(snappedNumber(0.0437, style), 0.04, 1e-15);
    EXPECT_EQ(snappedNumber(437, style), 400);
}

} // namespace
} // namespace tessera::app
