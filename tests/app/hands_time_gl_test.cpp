#include "app/pane/plot.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>

/// The mouse on the timeline: the knob, its buttons, the keys of an animation.
namespace tessera::app {
namespace {

class TimelineHands : public Hands {
protected:
    void showTimeline(const std::function<void(Session&)>& prepare = {}, glm::ivec2 size = {1000, 280}) {
        show(TimelineView{}, size, prepare);
    }
    /// Where the knob is drawn, at the end of what has the colour of the cursor.
    static float knob() {
        const ImRect ink = inked(plotColors().cursor);
        return ink.Max.x - ink.GetHeight() / 2;
    }
    /// Pixels of the first and the last time.
    std::pair<float, float> ends() {
        const double before = session().time;
        const auto knobAt = [this](double time) {
            session().time = time;
            frame();
            return knob();
        };
        const float first = knobAt(formula::kTimes[0]), last = knobAt(formula::kTimes[2]);
        session().time = before;
        frame();
        return {first, last};
    }
    void clickOn(const char* name) { click(inPane({name}).GetCenter()); }
};

TEST_F(TimelineHands, TheKnobFollowsTheMouseAndKeepsToStoredTimes) {
    showTimeline();
    const auto [first, last] = ends();
    ASSERT_GT(last - first, 800);
    const double perPixel = 2.0 / double(last - first);
    const float y = inPane({"track"}).Min.y + 10;
    const auto pixel = [&, lo = first](double time) { return ImVec2(lo + float(time / perPixel), y); };
    const Session before = session();
    moveTo(pixel(1.3));
    EXPECT_TRUE(session() == before) << apart(before);
    button(0, true);
    EXPECT_NEAR(session().time, 1.3, perPixel) << "a click goes there";
    for (const double time : {0.9, 1.7}) {
        moveTo(pixel(time));
        EXPECT_NEAR(session().time, time, perPixel);
        EXPECT_NEAR(knob(), mouse.x, 1) << "the knob is drawn there";
    }
    for (const float beside : {-4.0f, 0.0f, 4.0f}) {
        moveTo({pixel(0.5).x + beside, y});
        EXPECT_EQ(session().time, 0.5) << "near a mark that time exactly";
    }
    moveTo({pixel(0.5).x + 9, y});
    EXPECT_NEAR(session().time, 0.5 + 9 * perPixel, perPixel);
    moveTo({first - 300, y});
    EXPECT_EQ(session().time, 0);
    moveTo({last + 300, y});
    EXPECT_EQ(session().time, 2);
    button(0, false);
    moveTo(pixel(1));
    EXPECT_EQ(session().time, 2) << "let go";
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(TimelineHands, EveryStoredTimeHasItsMark) {
    showTimeline();
    const auto [first, last] = ends();
    const ImRect track = inked(plotColors().cursor);
    const auto marked = [&](double share) {
        const float x = float(first + (last - first) * share);
        bool above = false, below = false;
        for (const ImVec2& corner : drawnIn(plotColors().faint)) {
            if (std::abs(corner.x - x) > 2 || std::abs(corner.y - track.GetCenter().y) > 12) continue;
            (corner.y < track.GetCenter().y ? above : below) = true;
        }
        return above && below;
    };
    for (const double time : formula::kTimes) EXPECT_TRUE(marked(time / formula::kTimes[2])) << time;
    for (const double share : {0.1, 0.5, 0.9}) EXPECT_FALSE(marked(share)) << share;
}

// Below the track, beside it, or with the track among the buttons.
TEST_F(TimelineHands, BothEndsHaveTheirTimesHoweverLowThePane) {
    const auto apartFrom = [](const DrawnText& text, ImVec2 min, ImVec2 max) {
        return text.min.x >= max.x || text.max.x <= min.x || text.min.y >= max.y || text.max.y <= min.y;
    };
    for (const glm::ivec2 size : {glm::ivec2{1000, 280}, {1000, 84}, {1000, 70}, {1000, 60}, {450, 46}}) {
        SCOPED_TRACE(std::to_string(size.x) + " x " + std::to_string(size.y));
        mouse = {-1000, -1000}; // no tooltip
        showTimeline([](Session& session) { session.time = 0.5; }, size);
        const ImRect ink = inked(plotColors().cursor);
        EXPECT_GE(ink.Min.y, 0);
        EXPECT_LE(ink.Max.y, size.y) << "the knob is in sight";
        const std::vector<DrawnText> texts = drawnTexts();
        int first = 0, last = 0;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_TRUE(apartFrom(texts[i], ink.Min, ink.Max)) << texts[i].text;
            EXPECT_LE(texts[i].max.y, size.y) << texts[i].text;
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_TRUE(apartFrom(texts[i], texts[k].min, texts[k].max)) << texts[i].text << " " << texts[k].text;
            first += texts[i].text.starts_with("0.0") && texts[i].min.x < ink.Max.x;
            last += texts[i].text.starts_with("2.0") && texts[i].min.x > ink.Max.x;
        }
        EXPECT_EQ(first, 1);
        EXPECT_EQ(last, 1);
        const auto [begin, end] = ends();
        click({(begin + end) / 2, ink.GetCenter().y});
        EXPECT_NEAR(session().time, 1, 0.02) << "the middle of the track";
    }
}

TEST_F(TimelineHands, TheWheelGoesFromTimeToTime) {
    showTimeline();
    moveTo(inPane({"track"}).GetCenter());
    const auto expect = [&](float turn, double time) {
        turnWheel(turn);
        EXPECT_EQ(session().time, time);
    };
    expect(-1, 2);
    expect(-1, 2);
    expect(1, 0.5);
    expect(1, 0);
    expect(1, 0);
    expect(-1, 0.5);
    session().time = 1.7; // between: from the stored time that is nearer
    expect(1, 0.5);
}

TEST_F(TimelineHands, HoldingTheTrackPauses) {
    showTimeline([](Session& edited) { edited.animation.playing = true; });
    click(inPane({"track"}).GetCenter());
    EXPECT_FALSE(session().animation.playing);
}

TEST_F(TimelineHands, ButtonsStepAndPlay) {
    showTimeline();
    const auto expect = [&](const char* name, double time) {
        clickOn(name);
        EXPECT_EQ(session().time, time) << name;
    };
    expect("##first", 0);
    expect("##back", 0);
    expect("##forward", 0.5);
    expect("##last", 2);
    expect("##forward", 2);
    expect("##back", 0.5);
    session().animation.loop = Loop::Once;
    clickOn("##play");
    EXPECT_TRUE(session().animation.playing);
    EXPECT_EQ(session().time, 0.5);
    clickOn("##play");
    EXPECT_FALSE(session().animation.playing);
    session().time = 2;
    clickOn("##play");
    EXPECT_EQ(session().time, 0) << "a single run starts again";
    clickOn("##play");
    for (const Loop next : {Loop::Repeat, Loop::PingPong, Loop::Once}) {
        clickOn("##loop");
        EXPECT_EQ(session().animation.loop, next);
    }
    const ImRect speed = inPane({"##speed"});
    drag(speed.GetCenter(), {speed.Max.x + 50, speed.GetCenter().y});
    EXPECT_FLOAT_EQ(session().animation.speed, 60);
    drag({speed.Max.x - 6, speed.GetCenter().y}, {speed.Min.x - 50, speed.GetCenter().y});
    EXPECT_FLOAT_EQ(session().animation.speed, 0.1f);
}

class KeyHands : public TimelineHands {
protected:
    static constexpr const char* kTime = "/time";

    void showKeys(const std::vector<double>& at = {0, 4, 10}) {
        showTimeline([&](Session& edited) {
            Track track{kTime, {}};
            for (const double each : at) track.keys.push_back({each, {each / 5}, Easing::Linear});
            edited.animation.tracks = {track};
            edited.animation.duration = 10;
        });
        const ImRect ruler = item(window("keyframes"), {"ruler"}); // half an em longer at either end
        const float half = em() * 0.5f;
        row = {ruler.Min.x + half, ruler.Min.y, ruler.Max.x - half, ruler.Max.y};
    }
    const std::vector<Keyframe>& keys() { return session().animation.tracks.at(0).keys; }
    ImVec2 key(int index) { return item(window("keyframes"), {kTime, index, "key"}).GetCenter(); }
    double at(ImVec2 pixel) const { return across(row, {0, 10}, pixel); }
    ImRect row;
};

TEST_F(KeyHands, AKeyGoesWithTheMouseBetweenItsNeighbours) {
    showKeys();
    const Session before = session();
    const ImVec2 from = key(1);
    EXPECT_NEAR(at(from), 4, 0.02) << "drawn where it is";
    moveTo(from);
    button(0, true);
    for (const double share : {0.7, 0.15}) {
        moveTo({row.Min.x + float(share) * row.GetWidth(), from.y});
        EXPECT_NEAR(keys()[1].at, at(mouse), 1e-5);
    }
    moveTo({row.Max.x + 30, from.y});
    EXPECT_NEAR(keys()[1].at, 10 - 0.01, 1e-12);
    moveTo({row.Min.x - 30, from.y});
    EXPECT_NEAR(keys()[1].at, 0.01, 1e-12);
    moveTo({row.Min.x + 0.6f * row.GetWidth(), from.y + 40}); // only the way across counts
    EXPECT_NEAR(keys()[1].at, at(mouse), 1e-5);
    button(0, false);
    frame();
    Session expected = before;
    expected.animation.tracks[0].keys[1].at = keys()[1].at;
    EXPECT_TRUE(session() == expected) << "values and the other keys stay";
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(KeyHands, KeysEndWhereTheAnimationDoes) {
    showKeys({2, 6});
    ImVec2 from = key(0);
    moveTo(from);
    button(0, true);
    moveTo({row.Min.x - 60, from.y}); // at once, as a quick hand does
    button(0, false);
    EXPECT_EQ(keys()[0].at, 0);
    from = key(1);
    moveTo(from);
    button(0, true);
    moveTo({row.Max.x + 60, from.y});
    button(0, false);
    EXPECT_EQ(keys()[1].at, 10);
    const std::vector<Keyframe> before = keys();
    click(key(1));
    EXPECT_EQ(keys(), before) << "a click moves nothing";
}

TEST_F(KeyHands, TheRulerSaysWhichPlaceIsShown) {
    showKeys();
    moveTo({row.Min.x + 0.3f * row.GetWidth(), row.GetCenter().y});
    button(0, true);
    for (const double share : {0.3, 0.8}) {
        moveTo({row.Min.x + float(share) * row.GetWidth(), row.GetCenter().y});
        EXPECT_NEAR(session().animation.position, at(mouse), 1e-5);
        EXPECT_NEAR(session().time, at(mouse) / 5, 1e-5) << "what is keyed goes along";
    }
    moveTo({row.Max.x + 40, row.GetCenter().y});
    EXPECT_EQ(session().animation.position, 10);
    EXPECT_EQ(session().time, 2);
    moveTo({row.Min.x - 40, row.GetCenter().y});
    EXPECT_EQ(session().animation.position, 0);
    EXPECT_EQ(session().time, 0);
    button(0, false);
    frame();
    EXPECT_EQ(steps(), 0u) << "to look at another place is no edit";
}

TEST_F(KeyHands, KeysAreSetAndRemoved) {
    showTimeline([](Session& edited) { edited.animation.position = 1.5; });
    clickOn("Set time key");
    ASSERT_EQ(session().animation.tracks.size(), 1u);
    EXPECT_EQ(session().animation.tracks[0].path, kTime);
    ASSERT_EQ(keys().size(), 1u);
    EXPECT_EQ(keys()[0].at, 1.5);
    EXPECT_EQ(keys()[0].value, std::vector<double>{0.5});
    clickOn("Set camera key");
    const auto& tracks = session().animation.tracks;
    ASSERT_EQ(tracks.size(), 4u);
    for (const char* path : {"/camera/orientation", "/camera/target", "/camera/distance"})
        EXPECT_EQ(std::ranges::count(tracks, path, &Track::path), 1) << path;

    showKeys();
    const auto choose = [&](int index, const char* entry) {
        click(key(index), 1);
        ASSERT_TRUE(popup());
        click(item(popup(), {entry}).GetCenter());
        frame();
    };
    choose(1, "Go there");
    EXPECT_EQ(session().animation.position, 4);
    EXPECT_NEAR(session().time, 0.8, 1e-12);
    session().time = 1.9;
    choose(1, "Set to the current value");
    EXPECT_EQ(keys()[1].value, std::vector<double>{1.9});
    choose(1, "Slow start");
    EXPECT_EQ(keys()[1].easing, Easing::In);
    choose(1, "Remove");
    ASSERT_EQ(keys().size(), 2u);
    EXPECT_EQ(keys()[0].at, 0);
    EXPECT_EQ(keys()[1].at, 10);
    choose(0, "Remove");
    ASSERT_EQ(keys().size(), 1u);
    EXPECT_EQ(keys()[0].at, 10);
    choose(0, "Remove");
    EXPECT_TRUE(session().animation.tracks.empty()) << "with its last key the track goes";
}

} // namespace
} // namespace tessera::app
