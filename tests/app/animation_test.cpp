#include "app/history/animated_session.h"
#include "app/history/edit_titles.h"

#include "app/history/history.h"
#include "app/history/parameter_path.h"
#include "app/history/session_file.h"
#include "app/session/session.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

TEST(Easing, HasKnownValues) {
    EXPECT_EQ(eased(Easing::Linear, 0.3), 0.3);
    EXPECT_EQ(eased(Easing::Step, 0.999), 0);
    EXPECT_NEAR(eased(Easing::In, 0.5), 0.125, 1e-12);
    EXPECT_NEAR(eased(Easing::Out, 0.5), 0.875, 1e-12);
    EXPECT_NEAR(eased(Easing::InOut, 0.25), 0.0625, 1e-12);
    EXPECT_NEAR(eased(Easing::InOut, 0.5), 0.5, 1e-12);
    EXPECT_NEAR(eased(Easing::InOut, 0.75), 1 - 0.0625, 1e-12);
}

TEST(Easing, RunsFromNoughtToOneWithoutTurningBack) {
    for (int kind = 0; kind < int(std::size(kEasingNames)); ++kind) {
        const auto easing = static_cast<Easing>(kind);
        EXPECT_EQ(eased(easing, 0), 0) << kEasingNames[std::size_t(kind)];
        EXPECT_EQ(eased(easing, 1), 1) << kEasingNames[std::size_t(kind)];
        double before = 0;
        for (int i = 1; i <= 1000; ++i) {
            const double now = eased(easing, i / 1000.0);
            EXPECT_GE(now, before);
            before = now;
        }
    }
}

TEST(Tracks, GoThroughTheirKeysAndStandStillBeyondThem) {
    const Track track{"/time", {{1, {10}, Easing::Linear}, {3, {20}, Easing::In}, {4, {0}, Easing::Linear}}};
    const auto at = [&](double t) { return valueAt(track, t, Between::Line).at(0); };
    EXPECT_EQ(at(0), 10);
    EXPECT_EQ(at(1), 10);
    EXPECT_NEAR(at(1.5), 12.5, 1e-12);
    EXPECT_EQ(at(3), 20);
    EXPECT_NEAR(at(3.5), 20 - 20 * 0.125, 1e-12);
    EXPECT_EQ(at(99), 0);
    EXPECT_EQ(valueAt(track, 2, Between::Nothing).at(0), 10);
    EXPECT_TRUE(valueAt({}, 2, Between::Line).empty());
}

TEST(Tracks, RotationsTurnTheShortWayAtUnitLength) {
    const double half = std::sqrt(0.5);
    // A quarter turn about y, the second key as the negative of the same rotation.
    const Track track{"/camera/orientation", {{0, {1, 0, 0, 0}, Easing::Linear}, {1, {-half, 0, -half, 0}}}};
    const std::vector<double> middle = valueAt(track, 0.5, Between::Arc);
    const double eighth = glm::radians(22.5);
    EXPECT_THAT(middle, ElementsAre(DoubleNear(std::cos(eighth), 1e-9), DoubleNear(0, 1e-9),
                                    DoubleNear(std::sin(eighth), 1e-9), DoubleNear(0, 1e-9)));
}

TEST(Tracks, MoveEveryKindOfParameter) {
    Session session;
    session.layers.push_back({"O2", true, vis::VolumeLayer{.channel = "O2"}});
    EXPECT_EQ(betweenAt(session, "/camera/orientation"), Between::Arc);
    EXPECT_EQ(betweenAt(session, "/layers/0/technique/density"), Between::Line);
    EXPECT_EQ(betweenAt(session, "/layers/0/visible"), Between::Nothing);
    EXPECT_EQ(betweenAt(session, "/layers/0/technique/style"), Between::Nothing);
    EXPECT_TRUE(setNumbersAt(session, "/layers/0/technique/density", std::vector<double>{2.5}));
    EXPECT_TRUE(setNumbersAt(session, "/layers/0/visible", std::vector<double>{0}));
    EXPECT_TRUE(setNumbersAt(session, "/layers/0/technique/style", std::vector<double>{1}));
    EXPECT_TRUE(setNumbersAt(session, "/cursor", std::vector<double>{1, 2, 3}));
    const auto& volume = std::get<vis::VolumeLayer>(session.layers[0].technique);
    EXPECT_EQ(volume.density, 2.5f);
    EXPECT_EQ(volume.style, vis::RayStyle::Maximum);
    EXPECT_FALSE(session.layers[0].visible);
    EXPECT_EQ(session.cursor, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(setNumbersAt(session, "/layers/0/technique/density", std::vector<double>{1e9}));
    EXPECT_EQ(volume.density, 100) << "kept within its range";
    EXPECT_TRUE(setNumbersAt(session, "/camera/orientation", std::vector<double>{2, 4, 6, 8}));
    const double length = std::sqrt(120.0);
    EXPECT_NEAR(session.camera.orientation.w, 2 / length, 1e-6);
    EXPECT_NEAR(session.camera.orientation.x, 4 / length, 1e-6);
    EXPECT_NEAR(session.camera.orientation.y, 6 / length, 1e-6);
    EXPECT_NEAR(session.camera.orientation.z, 8 / length, 1e-6) << "of unit length";
    EXPECT_FALSE(setNumbersAt(session, "/cursor", std::vector<double>{1}));
    EXPECT_FALSE(setNumbersAt(session, "/layers/7/visible", std::vector<double>{1}));
    EXPECT_FALSE(setNumbersAt(session, "/layers/0/name", std::vector<double>{1}));
    EXPECT_FALSE(setNumbersAt(session, "/camera/distance", std::vector<double>{std::nan("")}));
}

TEST(Tracks, KeysAreSetMovedAndRemoved) {
    Session session;
    session.camera.distance = 2;
    EXPECT_TRUE(setKey(session, "/camera/distance"));
    session.animation.position = 4;
    session.camera.distance = 6;
    EXPECT_TRUE(setKey(session, "/camera/distance"));
    session.camera.distance = 7;
    EXPECT_TRUE(setKey(session, "/camera/distance")) << "replaces the key at the same place";
    EXPECT_FALSE(setKey(session, "/title"));
    EXPECT_FALSE(setKey(session, "/animation/speed"));
    ASSERT_EQ(session.animation.tracks.size(), 1u);
    ASSERT_EQ(session.animation.tracks[0].keys.size(), 2u);
    EXPECT_THAT(session.animation.tracks[0].keys[1].value, ElementsAre(7));
    applyTracks(session, 2);
    EXPECT_NEAR(session.camera.distance, 4.5, 1e-6) << "half way of an eased way";
    EXPECT_EQ(moveKey(session.animation, 0, 0, 99), 1u);
    EXPECT_EQ(session.animation.tracks[0].keys[1].at, session.animation.duration);
    removeKey(session.animation, 0, 1);
    removeKey(session.animation, 0, 0);
    EXPECT_TRUE(session.animation.tracks.empty());
}

TEST(Tracks, SurviveTheSessionFile) {
    Session session;
    session.animation.position = 1;
    setKey(session, "/camera/orientation");
    session.animation.tracks[0].keys[0].easing = Easing::Out;
    setKey(session, "/render/step");
    EXPECT_EQ(sessionFromJson(toJson(session), {}), session);
}

TEST(Tracks, ThoseThatDoNothingAreSaidWhereASessionIsOpened) {
    Session session;
    session.animation.tracks = {{"/camera/distance", {{0, {1}}, {1, {2, 3, 4}}}}, {"/camera/distant", {{0, {1}}}}};
    session.animation.tracks.push_back({"/animation/speed", {{0, {1}}}});
    const auto reopened = [&] {
        SessionDocument document;
        document.session = session;
        return parseSession(printSession(document, "a.tessera.json"), "a");
    };
    const SessionDocument opened = reopened();
    ASSERT_EQ(opened.messages.size(), 3u);
    EXPECT_EQ(opened.messages[0],
              "a: /animation/tracks/0/keys/1: the keyframe is ignored: it has 3 numbers, /camera/distance has 1");
    EXPECT_THAT(opened.messages[1], testing::HasSubstr("/animation/tracks/1: keyframes of \"/camera/distant\""));
    EXPECT_THAT(opened.messages[2], testing::HasSubstr("/animation/tracks/2"));
    session.animation.tracks.resize(1);
    session.animation.tracks[0].keys.pop_back();
    EXPECT_TRUE(reopened().messages.empty());
}

TEST(Tracks, WhatPlaysIsNoEdit) {
    Session session;
    setKey(session, "/camera/distance");
    session.animation.position = 5;
    session.camera.distance = 9;
    setKey(session, "/camera/distance");
    History history;
    history.reset(session);
    session.animation.playing = true;
    for (double at : {1.0, 2.0, 3.0}) {
        session.animation.position = at;
        applyTracks(session, at);
        EXPECT_FALSE(history.observe(session, false, at));
    }
    session.animation.playing = false;
    EXPECT_FALSE(history.observe(session, false, 4));
    session.render.samples = 7;
    EXPECT_TRUE(history.observe(session, false, 5));
    EXPECT_THAT(history.steps().back().forward.size(), 1u) << history.steps().back().forward;
    EXPECT_NE(history.undo().render.samples, 7);
}

TEST(ParameterPaths, NameWhatCanBeSetOneByOne) {
    Session session;
    session.layers.push_back({"O2", true, vis::VolumeLayer{.channel = "O2"}});
    const std::vector<std::string> paths = parameterPaths(session);
    for (const char* wanted :
         {"/render/filter", "/camera/distance", "/layers/0/technique/density", "/time", "/data/lattice"})
        EXPECT_NE(std::find(paths.begin(), paths.end(), wanted), paths.end()) << wanted;
    for (const std::string& path : paths) {
        bool found = false;
        EXPECT_TRUE(visitParameter(session, path, [&](const auto&, const FieldInfo&) { found = true; })) << path;
        EXPECT_TRUE(found) << path;
        EXPECT_TRUE(toJson(session).contains(Json::json_pointer(path))) << path;
    }
    EXPECT_FALSE(visitParameter(session, "/render/nothing", [](const auto&, const FieldInfo&) {}));
    EXPECT_FALSE(visitParameter(session, "/layers/1/name", [](const auto&, const FieldInfo&) {}));
    EXPECT_EQ(pathTitle(session, "/layers/0/technique/density"), "O2: density");
}

} // namespace
} // namespace tessera::app
