#include "app/described/describe_json.h"
#include "vis/scene/scene.h"

#include <gtest/gtest.h>
#include <set>

namespace tessera::app {
namespace {

TEST(Looks, PresetsAreDifferentAndRoundTrip) {
    std::set<std::string> seen;
    for (const std::string_view name : vis::Look::kPresetNames) {
        const std::optional<vis::Look> look = vis::Look::preset(name);
        ASSERT_TRUE(look) << name;
        EXPECT_EQ(look->any(), name != "plain") << name;
        EXPECT_TRUE(seen.insert(toJson(*look).dump()).second) << name << " is another one";
        vis::Look again;
        std::vector<JsonIssue> issues;
        fromJson(again, toJson(*look), issues);
        EXPECT_TRUE(issues.empty() && again == *look) << name;
    }
    EXPECT_GE(seen.size(), 7u);
    EXPECT_FALSE(vis::Look::preset("watercolour"));
}

TEST(Looks, NameOfAPresetStandsForIt) {
    vis::VolumeLayer layer;
    std::vector<JsonIssue> issues;
    fromJson(layer, Json::parse(R"({"channel": "T", "look": "chalk"})"), issues);
    EXPECT_TRUE(issues.empty());
    EXPECT_EQ(layer.look, vis::Look::preset("chalk"));
    fromJson(layer, Json::parse(R"({"look": "watercolour"})"), issues);
    ASSERT_EQ(issues.size(), 1u);
    EXPECT_EQ(issues[0].path, "/look");
    EXPECT_EQ(layer.look, vis::Look::preset("chalk")) << "left alone";
}

TEST(Looks, DrawingsBringTheirPaper) {
    vis::Scene scene;
    scene.layers = {{"", true, vis::VolumeLayer{.channel = "T"}}};
    EXPECT_FALSE(vis::paperOf(scene));
    EXPECT_EQ(vis::groundColor(scene), scene.background);
    auto& look = std::get<vis::VolumeLayer>(scene.layers[0].technique).look;
    look = *vis::Look::preset("charcoal");
    ASSERT_TRUE(vis::paperOf(scene));
    const float light = vis::groundColor(scene).g;
    look = *vis::Look::preset("chalk");
    EXPECT_LT(vis::groundColor(scene).g, 0.5f * light) << "chalk on dark paper";
    scene.paper = vis::Paper{.color = glm::vec3(1)};
    EXPECT_EQ(vis::groundColor(scene), glm::vec3(1));
    scene.paper.reset();
    scene.layers[0].visible = false;
    EXPECT_FALSE(vis::paperOf(scene));
}

} // namespace
} // namespace tessera::app
