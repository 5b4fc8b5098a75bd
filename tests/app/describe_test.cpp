#include "app/session/session.h"
#include "randomise.h"
#include "volume/base/error.h"

#include <gtest/gtest.h>
#include <set>

namespace tessera::app {
namespace {

/// Every described struct of the program.
using Structs = ::testing::Types<
    vis::Camera, vis::VolumeLayer, vis::IsoLayer, vis::SliceLayer, vis::FlowLayer, vis::Layer, vis::RenderParams,
    vis::Light, vis::EnvironmentLight, vis::Shadows, vis::Lighting, vis::Clip, vis::Tone, vis::BrushInterval,
    vis::RangeRegion, vis::EllipseRegion, vis::LassoRegion, vis::SphereRegion, vis::BoxRegion, vis::LensRegion,
    vis::Lens, vis::Brush, vis::Selection, vis::TransferFunction, DockNode, FloatingPane, DockTree, DataFile, OtherData,
    DataRef, Animation, Appearance, VolumeView, SlicesView, ScatterMatrixView, TransferView, LayersView, TimelineView,
    DataView, HistoryView, LogView, StatisticsView, HistogramView, ProfileView, SliceMatrixView, ShadowCubeView,
    TesseractView, CurvesView, vis::Look, vis::Paper, volume::DerivedParameter, Session>;

template <class T> class DescribeTest : public ::testing::Test {};
TYPED_TEST_SUITE(DescribeTest, Structs);

TYPED_TEST(DescribeTest, RoundTripsRandomValues) {
    std::mt19937 random(7);
    for (int i = 0; i < 1000; ++i) {
        const TypeParam value = randomValue<TypeParam>(random);
        const std::string text = printJson(toJson(value));
        TypeParam back{};
        std::vector<JsonIssue> issues;
        fromJson(back, parseJson(text, "test"), issues);
        ASSERT_TRUE(issues.empty()) << issues.front().path << ": " << issues.front().reason << "\n" << text;
        ASSERT_TRUE(back == value) << text;
        ASSERT_EQ(printJson(toJson(back)), text);
    }
}

TYPED_TEST(DescribeTest, DefaultsAreValidKeysUniqueAndDocumented) {
    TypeParam value{};
    std::vector<JsonIssue> issues;
    fromJson(value, toJson(TypeParam{}), issues);
    EXPECT_TRUE(issues.empty()) << issues.front().path << ": " << issues.front().reason;
    std::set<std::string> keys;
    TypeParam::describe(value, [&](auto&, const FieldInfo& info) {
        EXPECT_TRUE(keys.insert(std::string(info.key)).second) << "key used twice: " << info.key;
        EXPECT_NE(info.key, "type") << "taken by variants";
        EXPECT_FALSE(info.doc.empty()) << info.key;
    });
}

TYPED_TEST(DescribeTest, MissingKeysKeepTheValue) {
    std::mt19937 random(11);
    const TypeParam value = randomValue<TypeParam>(random);
    TypeParam back = value;
    std::vector<JsonIssue> issues;
    fromJson(back, Json::object(), issues);
    EXPECT_TRUE(issues.empty());
    EXPECT_TRUE(back == value);
}

TYPED_TEST(DescribeTest, WrongTypesAreReportedAndLeaveTheValue) {
    // Every leaf in turn becomes an object nobody knows: an issue at its path, nothing thrown.
    const Json document = toJson(TypeParam{});
    for (const auto& [key, member] : document.items()) {
        Json broken = document;
        broken[key] = member.is_boolean() ? Json(3) : Json(true);
        TypeParam value{};
        std::vector<JsonIssue> issues;
        fromJson(value, broken, issues);
        ASSERT_EQ(issues.size(), 1u) << key;
        EXPECT_EQ(issues[0].path, "/" + key);
        EXPECT_FALSE(issues[0].unknownKey);
        EXPECT_TRUE(value == TypeParam{}) << key;
    }
}

TEST(DescribeJson, FloatsAreShort) {
    vis::IsoLayer layer;
    layer.opacity = 0.1f;
    EXPECT_EQ(toJson(layer)["opacity"].dump(), "0.1");
}

TEST(DescribeJson, ReportsPlaceAndReason) {
    Session session;
    session.layers.push_back({"a", true, vis::IsoLayer{}});
    Json document = toJson(session);
    document["layers"][0]["technique"]["opacity"] = 1.5;
    document["layers"][0]["technique"]["glow"] = 1;
    document["layers"][0]["visible"] = "yes";
    document["render"]["filter"] = "best";
    std::vector<JsonIssue> issues;
    Session back;
    fromJson(back, document, issues);
    ASSERT_EQ(issues.size(), 4u);
    EXPECT_EQ(issues[0].path, "/layers/0/visible");
    EXPECT_EQ(issues[1].path, "/layers/0/technique/opacity");
    EXPECT_EQ(issues[1].reason, "1.5 is not in 0 .. 1");
    EXPECT_EQ(issues[2].path, "/layers/0/technique/glow");
    EXPECT_TRUE(issues[2].unknownKey);
    EXPECT_EQ(issues[3].path, "/render/filter");
    EXPECT_EQ(back.layers[0].visible, true);
}

TEST(DescribeJson, UnknownVariantTypeNamesTheKnownOnes) {
    Json document = toJson(vis::Layer{});
    document["technique"]["type"] = "hologram";
    std::vector<JsonIssue> issues;
    vis::Layer layer;
    fromJson(layer, document, issues);
    ASSERT_EQ(issues.size(), 1u);
    EXPECT_EQ(issues[0].path, "/technique/type");
    EXPECT_EQ(issues[0].reason, "unknown type \"hologram\"; known are volume, iso, slice, flow");
}

TEST(DescribeJson, BrokenTextSaysWhere) {
    try {
        parseJson("{\n  \"a\": 1,\n  \"b\" 2\n}", "x.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "x.json");
        EXPECT_EQ(error.place().substr(0, 6), "line 3");
    }
    EXPECT_THROW(parseJson(std::string(100000, '['), "deep.json"), Error);
    std::string deep;
    for (int i = 0; i < 1000; ++i) deep += "{\"children\":[";
    EXPECT_THROW(parseJson(deep, "deep.json"), Error);
}

} // namespace
} // namespace tessera::app
