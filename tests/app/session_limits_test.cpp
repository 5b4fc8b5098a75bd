// What a session may hold, and what it may not say.
#include "app/edits/add_layer.h"
#include "app/edits/compare.h"
#include "app/history/history.h"
#include "app/history/session_file.h"
#include "app/session/session_json.h"
#include "volume/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

namespace tessera::app {
namespace {

std::string sessionWith(const std::string& list, const std::string& one, std::size_t count) {
    std::string text = R"({"schema": )" + std::to_string(kSessionSchema) + ", \"" + list + "\": [";
    for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + one;
    return text + "]}";
}

std::string reasonOf(const std::string& text) {
    try {
        parseSession(text, "x");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SessionLimits, MoreLayersThanAreDrawnAreNeitherReadNorMade) {
    const std::string layer = R"({"technique": {"type": "volume"}})";
    EXPECT_EQ(parseSession(sessionWith("layers", layer, kMostLayers), "x").session.layers.size(), kMostLayers);
    EXPECT_EQ(reasonOf(sessionWith("layers", layer, kMostLayers + 1)),
              "x: /layers: has 101 layers, more than 100 are not drawn");
    Session session;
    for (std::size_t n = 0; n < 2 * kMostLayers; ++n) addLayer(session, {});
    EXPECT_EQ(sessionFromJson(toJson(session), {}).layers.size(), kMostLayers) << "what is made here is read again";
}

TEST(SessionLimits, ListsDoNotGoOnForEver) {
    EXPECT_EQ(parseSession(sessionWith("clips", "{}", 10'000), "x").session.clips.size(), 10'000u);
    EXPECT_THAT(reasonOf(sessionWith("clips", "{}", 10'001)), testing::HasSubstr("more than 10000"));
    Session session;
    session.data.import.times.resize(20'000, 1);
    EXPECT_EQ(sessionFromJson(toJson(session), {}).data.import.times.size(), 20'000u);
}

TEST(SessionLimits, WhatTheUserAllowedIsNotInTheFileButLastsWhileItIsOpen) {
    Session session;
    session.data.import.allowOutside = true;
    session.data.other = OtherData{};
    session.data.other->import.allowOutside = true;
    EXPECT_EQ(toJson(session).dump().find("allowOutside"), std::string::npos);
    EXPECT_FALSE(sessionFromJson(toJson(session), {}).data.import.allowOutside);
    EXPECT_FALSE(parseSession(R"({"schema": )" + std::to_string(kSessionSchema) +
                                  R"(, "data": {"import": {"allowOutside": true}}})",
                              "x")
                     .session.data.import.allowOutside);
    History history;
    history.reset(session);
    session.camera.distance = 7;
    history.observe(session, false, 0);
    for (const Session& walked : {history.undo(), history.redo()}) {
        EXPECT_TRUE(walked.data.import.allowOutside);
        EXPECT_TRUE(walked.data.other && walked.data.other->import.allowOutside);
    }
    EXPECT_TRUE(variantSession(session, {"", {{"/time", "0.5"}}}).data.import.allowOutside);
}

} // namespace
} // namespace tessera::app
