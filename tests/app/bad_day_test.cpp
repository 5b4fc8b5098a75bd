#include "app/data/open.h"
#include "app/edits/compare.h"
#include "app/history/animated_session.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>

/// Sessions that hold nonsense: one line says what and where, or it is harmless; nothing is half taken over.
namespace tessera::app {
namespace {

Json recordedJson(const std::string& name) {
    return Json::parse(readText(TESSERA_SOURCE_DIR "/tests/sessions/" + name + ".tessera.json"));
}

struct Nonsense {
    const char *path, *value;
};

/// The message of parsing the session with one value replaced; "" if it is taken.
std::string refused(Json document, const Nonsense& bad) {
    document.erase("history"); // it would lead elsewhere, which is another message
    document[Json::json_pointer(bad.path)] = Json::parse(bad.value);
    try {
        parseSession(document.dump(), "bad.tessera.json");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void expectOneLineNaming(const std::string& session, const std::vector<Nonsense>& all) {
    const Json document = recordedJson(session);
    for (const Nonsense& bad : all) {
        SCOPED_TRACE(std::string(bad.path) + " = " + bad.value);
        const std::string message = refused(document, bad);
        EXPECT_NE(message.find(bad.path), std::string::npos) << message;
        EXPECT_NE(message.find("bad.tessera.json"), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
        EXPECT_LT(message.size(), 400u);
    }
}

TEST(BadDay, LensesAndBrushes) {
    expectOneLineNaming("lens", {{"/lenses/0/shape", "\"triangle\""},
                                 {"/lenses/0/effect", "7"},
                                 {"/lenses/0/size", "[0.1, 0.1]"},
                                 {"/lenses/0/size", "[1e30, 0.1, 0.1]"},
                                 {"/lenses/0/size", "\"large\""},
                                 {"/lenses/0/center", "[0, null, 0]"},
                                 {"/lenses/0/rim", "-1"},
                                 {"/lenses/0/enabled", "\"yes\""},
                                 {"/lenses", "{}"},
                                 {"/selection/brushes", "[{\"region\": {\"type\": \"cone\"}}]"}});
}

TEST(BadDay, LooksAndLayers) {
    expectOneLineNaming("illustration", {{"/layers/0/technique/look", "\"watercolour\""},
                                         {"/layers/0/technique/look", "{\"tone\": 3}"},
                                         {"/layers/0/technique/type", "\"hologram\""},
                                         {"/layers/0/technique", "[]"},
                                         {"/layers/0/timeShift", "\"later\""},
                                         {"/render/filter", "\"sharpest\""},
                                         {"/camera/orientation", "[0, 0]"}});
}

TEST(BadDay, KeyframesAndComparisons) {
    expectOneLineNaming("pulse",
                        {{"/animation/loop", "\"spiral\""},
                         {"/animation/duration", "-5"},
                         {"/animation/tracks", "7"},
                         {"/animation/tracks", "[{\"path\": \"/time\", \"keys\": [{\"easing\": \"bouncy\"}]}]"},
                         {"/views/volume/type", "\"crystal ball\""},
                         {"/time", "\"noon\""}});
}

// What is well formed but means nothing is left alone: tracks of unknown parameters, keys without values, variants that
// cannot be.
TEST(BadDay, TracksAndVariantsOfNothingAreHarmless) {
    Session session = parseSession(recordedJson("pulse").dump(), "pulse").session;
    session.animation.tracks = {{"/no/such/parameter", {{0, {1}, Easing::Linear}, {1, {2}, Easing::Linear}}},
                                {"/time", {{0, {}, Easing::InOut}, {1, {}, Easing::InOut}}},
                                {"/camera/orientation", {{0, {1}, Easing::InOut}, {2, {0, 0, 0, 0}, Easing::InOut}}},
                                {"/camera/distance", {{0, {1e300}, Easing::Step}, {0, {-1e300}, Easing::Step}}},
                                {"", {}}};
    for (const double at : {-1.0, 0.0, 0.5, 1.5, 1e9}) {
        Session now = session;
        applyTracks(now, at);
        EXPECT_GT(now.camera.distance, 0);
        const glm::quat turn = now.camera.orientation;
        EXPECT_NEAR(glm::dot(turn, turn), 1, 1e-3) << at;
    }
    // Every variant of a comparison fails by itself, with the path.
    for (const auto& [path, value] : {std::pair{"/layers/99/visible", "true"},
                                      {"/render/step", "\"wide\""},
                                      {"/lenses/0/size", "[]"},
                                      {"not a pointer", "1"},
                                      {"/render", "{\"step\": -1}"}})
        EXPECT_THROW(variantSession(session, {"", {{path, value}}}), Error) << path;
}

// A history that does not lead to the session is dropped, with a message; the session itself is kept.
TEST(BadDay, ABrokenHistoryCostsTheHistoryAlone) {
    for (const char* name : {"starvation", "lens", "tesseract"}) {
        Json document = recordedJson(name);
        const Session whole = parseSession(document.dump(), name).session;
        document["history"]["steps"][0]["forward"] = Json::array({{{"op", "remove"}, {"path", "/nowhere"}}});
        const SessionDocument back = parseSession(document.dump(), name);
        EXPECT_EQ(back.session, whole);
        EXPECT_TRUE(back.history.steps().empty());
        ASSERT_FALSE(back.messages.empty());
        EXPECT_NE(back.messages[0].find("/history"), std::string::npos) << back.messages[0];
    }
}

// Fifty edits back and fifty on again, whatever they were.
TEST(BadDay, FiftyUndosAndRedos) {
    SessionDocument document = parseSession(recordedJson("lens").dump(), "lens");
    const Session start = document.session;
    History history;
    history.reset(start);
    Session now = start;
    for (int i = 0; i < 50; ++i) {
        switch (i % 5) {
        case 0:
            now.lenses.front().size *= 1.01f;
            break;
        case 1:
            now.cursor.z += 1e-4;
            break;
        case 2:
            now.selection.brushes.push_back(vis::rangeBrush({{"T", 354.0 + i, 400, 1}}, std::to_string(i)));
            break;
        case 3:
            now.layers.front().visible = !now.layers.front().visible;
            break;
        default:
            now.camera.distance += 0.01f;
            break;
        }
        ASSERT_TRUE(history.observe(now, false, i * 10.0));
    }
    for (int round = 0; round < 2; ++round) {
        Session back = now;
        for (int i = 0; i < 50; ++i) back = history.undo();
        EXPECT_EQ(back, start);
        EXPECT_FALSE(history.canUndo());
        Session again;
        for (int i = 0; i < 50; ++i) again = history.redo();
        EXPECT_EQ(again, now);
        EXPECT_FALSE(history.canRedo());
    }
}

} // namespace
} // namespace tessera::app
