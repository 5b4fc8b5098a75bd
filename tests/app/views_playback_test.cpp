#include "app/ui/theme.h"
#include "app/views/timeline/playback.h"
#include "app/views/transfer/opacity_edit.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <cmath>
#include <gmock/gmock.h>

namespace tessera::app {
namespace {

const std::vector<double> kTimes{0, 0.1, 0.2, 0.5};

std::vector<double> play(Animation animation, double time, int steps) {
    Playback playback;
    std::vector<double> seen;
    for (int i = 0; i < steps; ++i) {
        advance(playback, animation, time, kTimes, 1.0 / static_cast<double>(animation.speed) + 1e-9);
        seen.push_back(time);
        if (!animation.playing) break;
    }
    return seen;
}

TEST(Playback, RepeatsTurnsRoundOrStops) {
    Animation animation;
    animation.playing = true;
    EXPECT_THAT(play(animation, 0.1, 5), testing::ElementsAre(0.2, 0.5, 0, 0.1, 0.2));
    animation.loop = Loop::PingPong;
    EXPECT_THAT(play(animation, 0.1, 7), testing::ElementsAre(0.2, 0.5, 0.2, 0.1, 0, 0.1, 0.2));
    animation.loop = Loop::Once;
    EXPECT_THAT(play(animation, 0.1, 7), testing::ElementsAre(0.2, 0.5, 0.5));
}

TEST(Playback, KeepsItsSpeedWhateverTheFrameRate) {
    for (const double frame : {0.01, 0.03, 0.11}) {
        Animation animation;
        animation.playing = true;
        animation.speed = 10;
        Playback playback;
        std::vector<double> times;
        for (int i = 0; i < 1000; ++i) times.push_back(i);
        double time = 0, elapsed = 0;
        while (elapsed < 5) {
            advance(playback, animation, time, times, frame);
            elapsed += frame;
        }
        EXPECT_NEAR(time, elapsed * 10, 1.5) << frame;
    }
}

TEST(Playback, StaysPutWhenPausedOrStatic) {
    Animation animation;
    Playback playback;
    double time = 0.1;
    advance(playback, animation, time, kTimes, 10);
    EXPECT_EQ(time, 0.1);
    animation.playing = true;
    advance(playback, animation, time, {0.1}, 10);
    EXPECT_EQ(time, 0.1);
}

/// A curve over values 0..10 in a plot of 200 x 100 pixels, driven by a fed mouse.
class OpacityEdit : public FedImGui {
protected:
    OpacityEdit() : FedImGui({400, 300}) {}
    void SetUp() override {
        frame();
        frame();
    }
    void frame() {
        const auto body = [&] {
            surface(plot.min, plot.max);
            editOpacity(drag, curve, plot, {0, 10});
        };
        feedWindow(body, 1); // clicks a second apart are no double clicks
    }
    void button(int which, bool down) {
        ImGui::GetIO().MouseDown[which] = down;
        frame();
    }
    void moveTo(double x, double y) {
        mouse = plot.pixel(x, y);
        frame();
    }

    PlotFrame plot{{50, 50}, {250, 150}, {0, 10}, {0, 1}};
    std::vector<glm::vec2> curve = opacityPreset(OpacityPreset::Ramp);
    OpacityDrag drag;
};

TEST_F(OpacityEdit, AClickAddsAPointThatCanBeDraggedAtOnce) {
    moveTo(5, 0.9);
    button(0, true);
    ASSERT_EQ(curve.size(), 3u);
    moveTo(6, 0.5);
    moveTo(20, 0.5); // no further than its neighbour
    button(0, false);
    EXPECT_NEAR(curve[1].x, 1, 1e-6);
    EXPECT_NEAR(curve[1].y, 0.5, 0.02);
    EXPECT_EQ(drag.point, -1);
}

TEST_F(OpacityEdit, RightClickRemovesButTwoPointsStay) {
    curve = {{0, 0}, {0.5f, 0.5f}, {1, 1}};
    moveTo(5, 0.5);
    button(1, true);
    button(1, false);
    EXPECT_EQ(curve.size(), 2u);
    moveTo(0, 0.02);
    button(1, true);
    button(1, false);
    EXPECT_EQ(curve.size(), 2u);
}

TEST(OpacityPresets, AreSortedAndWithinBounds) {
    for (std::size_t i = 0; i < std::size(kOpacityPresetNames); ++i) {
        const std::vector<glm::vec2> curve = opacityPreset(static_cast<OpacityPreset>(i));
        ASSERT_GE(curve.size(), 2u);
        for (std::size_t k = 0; k < curve.size(); ++k) {
            EXPECT_TRUE(curve[k].y >= 0 && curve[k].y <= 1);
            EXPECT_TRUE(k == 0 || curve[k].x >= curve[k - 1].x);
        }
        EXPECT_EQ(curve.front().x, 0);
        EXPECT_EQ(curve.back().x, 1);
    }
}

TEST_F(OpacityEdit, EveryPointHasARim) {
    loadFonts(1);
    applyTheme(Theme::Dark, 1);
    curve = {{0.1f, 0.2f}, {0.5f, 0.9f}, {0.8f, 0.4f}};
    feedWindow([&] { drawOpacity(*ImGui::GetWindowDrawList(), curve, plot, {0, 10}, 1); });
    const auto around = [&](ImU32 color, ImVec2 at) {
        return std::ranges::any_of(
            drawnIn(color), [&](ImVec2 corner) { return std::hypot(corner.x - at.x, corner.y - at.y) < 0.6f * em(); });
    };
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const ImVec2 at = plot.pixel(10 * double(curve[i].x), double(curve[i].y));
        EXPECT_TRUE(around(plotColors().backdrop, at)) << i;
        EXPECT_TRUE(around(i == 1 ? plotColors().focus : plotColors().text, at)) << i;
    }
    for (const ImVec2& corner : drawnIn(plotColors().backdrop)) EXPECT_GT(corner.x, plot.min.x - em());
}

/// Times are not passed over while views still wait for one; but views that take long do not hold playing up.
TEST(Playback, WaitsForViews) {
    Animation animation;
    animation.speed = 10;
    animation.playing = true;
    double time = 0;
    Playback playback;
    const auto frame = [&](double seconds, bool behind) {
        advance(playback, animation, time, kTimes, seconds, behind);
        return time;
    };
    EXPECT_EQ(frame(0.1 + 1e-9, false), kTimes[1]);
    EXPECT_EQ(frame(0.12, true), kTimes[1]);
    EXPECT_EQ(frame(0.12, true), kTimes[1]);
    EXPECT_EQ(frame(0.001, false), kTimes[2]) << "at once";
    EXPECT_EQ(frame(0.09, false), kTimes[2]) << "what was waited for is not made up for";
    time = 0;
    playback = {};
    EXPECT_EQ(frame(0.13, true), kTimes[0]);
    EXPECT_EQ(frame(0.13, true), kTimes[2]) << "after a quarter of a second as fast as was asked for";
}

} // namespace
} // namespace tessera::app
