#include "app/queries/focus_layers.h"

#include <gtest/gtest.h>

/// What is brushed is seen whatever the transfer function says.
namespace tessera::app {
namespace {

volume::DatasetInfo infoOfTwo() {
    volume::DatasetInfo info;
    info.parameters.resize(2);
    info.parameters[0].name = "a";
    info.parameters[0].ranges = {{0, 10}};
    info.parameters[1].name = "b";
    info.parameters[1].ranges = {{0, 1}};
    return info;
}

vis::Scene brushedScene(const std::string& channel, double lo, double hi) {
    vis::Scene scene;
    scene.layers = {{"a", true, vis::VolumeLayer{.channel = "a"}}};
    scene.transfer["a"].opacity = {{0, 0}, {0.5f, 0}, {0.6f, 0.8f}, {1, 0.8f}};
    scene.selection.brushes = {vis::rangeBrush({{.channel = channel, .lo = lo, .hi = hi}})};
    return scene;
}

TEST(FocusLayers, WhatTheFunctionHidesGetsAVolumeOfItsOwn) {
    vis::Scene scene = brushedScene("a", 1, 4);
    addFocusLayers(scene, infoOfTwo());
    ASSERT_EQ(scene.layers.size(), 2u);
    const vis::Layer& focus = scene.layers[1];
    EXPECT_EQ(std::get<vis::VolumeLayer>(focus.technique).channel, "a");
    EXPECT_EQ(focus.brushes, vis::BrushEffect::FocusOnly) << "the rest keeps the opacity it had";
    for (const double value : {0.0, 2.0, 10.0})
        EXPECT_FLOAT_EQ(float(vis::evaluate(scene.transfer.at(focus.transfer), {0, 10}, value).a),
                        scene.selection.focusOpacity);
    EXPECT_EQ(scene.transfer.at("a"), brushedScene("a", 1, 4).transfer.at("a"));
}

TEST(FocusLayers, NoneWhereAllThatIsBrushedIsOpaqueOrNothingIs) {
    const auto layers = [](vis::Scene scene) {
        addFocusLayers(scene, infoOfTwo());
        return scene.layers.size();
    };
    EXPECT_EQ(layers(brushedScene("a", 7, 9)), 1u) << "0.8 is enough";
    EXPECT_EQ(layers(brushedScene("b", 0.7, 0.9)), 2u) << "any value of a may be brushed";
    vis::Scene inverted = brushedScene("a", 7, 9);
    inverted.selection.brushes[0].inverted = true;
    EXPECT_EQ(layers(inverted), 2u);
    vis::Scene joined = brushedScene("a", 7, 9);
    joined.selection.brushes.push_back(vis::rangeBrush({{.channel = "b", .lo = 0, .hi = 0.2}}));
    joined.selection.brushes[1].combine = vis::BrushCombine::Or;
    EXPECT_EQ(layers(joined), 2u);
    vis::Scene none = brushedScene("a", 1, 4);
    none.selection.brushes[0].enabled = false;
    EXPECT_EQ(layers(none), 1u);
    vis::Scene off = brushedScene("a", 1, 4);
    off.selection.focusOpacity = 0;
    EXPECT_EQ(layers(off), 1u);
    vis::Scene whole = brushedScene("a", 1, 4);
    whole.layers[0].brushes = vis::BrushEffect::None;
    EXPECT_EQ(layers(whole), 1u) << "the layer does not fade what is not brushed";
}

TEST(FocusLayers, SurfacesAloneGetAVolumeOfTheirParameter) {
    vis::Scene scene = brushedScene("b", 0.1, 0.2);
    scene.layers = {{"hull", true, vis::IsoLayer{.channel = "a", .value = 5}}};
    addFocusLayers(scene, infoOfTwo());
    ASSERT_EQ(scene.layers.size(), 2u);
    EXPECT_EQ(std::get<vis::VolumeLayer>(scene.layers[1].technique).channel, "a");
}

} // namespace
} // namespace tessera::app
