#include "vis/scene/drawn_scene.h"
#include "vis/shapes/mesh_medium.h"
#include "vis/shapes/proxy.h"

#include <gtest/gtest.h>
#include <memory>

namespace tessera::vis {
namespace {

/// Scalars "a" and "b", a vector "U" and labels "region".
volume::DatasetInfo dataInfo() {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.times = {0};
    for (const char* name : {"a", "b", "U", "region"}) {
        volume::Parameter& parameter = info.parameters.emplace_back();
        parameter.name = name;
        parameter.ranges = {{0, 8}};
    }
    info.parameters[2].components = 3;
    info.parameters[2].ranges.assign(4, {0, 8});
    info.parameters[3].categorical = true;
    return info;
}

std::string nameOf(const volume::DatasetInfo& info, const DrawnChannel& channel) {
    return info.channel(channel.channel).name;
}

TEST(DrawnScene, LeavesOutWhatRaysDoNotMeet) {
    Scene scene;
    scene.lenses = {Lens{.name = "on"}, Lens{.name = "off", .enabled = false}};
    scene.layers = {{"shown", true, VolumeLayer{.channel = "a"}},
                    {"hidden", false, VolumeLayer{.channel = "a"}},
                    {"of nothing", true, VolumeLayer{.channel = "c"}},
                    {"polygons", true, IsoLayer{.channel = "a", .method = SurfaceMethod::Polygons}},
                    {"flow", true, FlowLayer{.vector = "U", .channel = "a"}},
                    {"surface", true, IsoLayer{.channel = "a"}, "on"},
                    {"lens is off", true, IsoLayer{.channel = "a"}, "off"},
                    {"lens is missing", true, SliceLayer{.channel = "a"}, "nobody's"},
                    {"slice", true, SliceLayer{.channel = "U"}}};
    const volume::DatasetInfo info = dataInfo();
    const DrawnScene drawn = drawnScene(scene, info);
    ASSERT_EQ(drawn.layers.size(), 3u);
    EXPECT_TRUE(drawn.layers[0].layer == 0 && drawn.layers[0].volume && drawn.layers[0].lens == -1);
    EXPECT_TRUE(drawn.layers[1].layer == 5 && drawn.layers[1].surface && drawn.layers[1].lens == 0);
    EXPECT_TRUE(drawn.layers[2].layer == 8 && drawn.layers[2].slice);
    EXPECT_EQ(nameOf(info, drawn.layers[2].shown), "|U|") << "a vector is shown by its length";
}

// Of a volume the function of its own is that of its opacity, of a coloured surface that of its colours.
TEST(DrawnScene, TheFunctionOfALayerIsOfItsValuesOrOfItsColours) {
    Scene scene;
    scene.transfer["own"].gradientTop = 3;
    scene.transfer["a"].gradientTop = 4;
    scene.transfer["b"].gradientTop = 5;
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .colorBy = "b"}, "", "own"},
                    {"", true, IsoLayer{.channel = "a", .colorBy = "b"}, "", "own"},
                    {"", true, IsoLayer{.channel = "a"}, "", "own"},
                    {"", true, IsoLayer{.channel = "a", .colorBy = "c"}, "", "own"},
                    {"", true, SliceLayer{.channel = "a"}}};
    const DrawnScene drawn = drawnScene(scene, dataInfo());
    ASSERT_EQ(drawn.layers.size(), 5u);
    const auto shown = [&](int i) { return drawn.layers[std::size_t(i)].shown.function->gradientTop; };
    const auto colors = [&](int i) { return drawn.layers[std::size_t(i)].colors.value().function->gradientTop; };
    EXPECT_TRUE(shown(0) == 3 && colors(0) == 5);
    EXPECT_TRUE(shown(1) == 4 && colors(1) == 3);
    EXPECT_EQ(shown(2), 3);
    EXPECT_TRUE(shown(3) == 3 && !drawn.layers[3].colors) << "the data have no such parameter";
    EXPECT_EQ(shown(4), 4);
}

TEST(DrawnScene, OnlyWhatIsInterpolatedByValueIsClassifiedAsAsked) {
    const auto drawnAs = [](VolumeLayer layer, TransferKind kind = TransferKind::Curve) {
        Scene scene;
        layer.classification = Classification::PreIntegrated;
        layer.shaded = true;
        scene.transfer[layer.channel].kind = kind;
        scene.layers = {{"", true, layer}};
        DrawnLayer drawn = drawnScene(scene, dataInfo()).layers.at(0);
        return std::tuple(drawn.classification == Classification::PreIntegrated, drawn.byRegions, drawn.shaded,
                          drawn.look != nullptr);
    };
    EXPECT_EQ(drawnAs({.channel = "a"}), std::tuple(true, false, true, true));
    EXPECT_EQ(drawnAs({.channel = "a"}, TransferKind::Regions), std::tuple(false, true, true, true));
    EXPECT_EQ(drawnAs({.channel = "a", .quantity = Quantity::Gradient}), std::tuple(false, false, true, true));
    EXPECT_EQ(drawnAs({.channel = "region"}), std::tuple(false, false, false, true)) << "labels have no gradient";
    EXPECT_EQ(drawnAs({.channel = "a", .style = RayStyle::Maximum}), std::tuple(false, false, false, false));
}

TEST(DrawnScene, GeometryIsColouredByTheLengthOfAVector) {
    Scene scene;
    scene.transfer["|U|"].gradientTop = 3;
    auto mesh = std::make_shared<Geometry>();
    mesh->mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh->mesh.triangles = {{0, 1, 2}};
    mesh->mesh.scalars = {1, 2, 3};
    GeometryLayer layer;
    layer.geometry = mesh;
    layer.channel = "U";
    scene.geometry = {layer, layer, layer};
    scene.geometry[1].lens = "nobody's";
    scene.geometry[2].channel.clear();
    const volume::DatasetInfo info = dataInfo();
    ASSERT_EQ(drawnGeometry(scene, {}).size(), 2u);
    EXPECT_EQ(colorsOf(scene, info, scene.geometry[0]).value().function->gradientTop, 3);
    EXPECT_FALSE(colorsOf(scene, info, scene.geometry[2]));
    scene.lighting.shadows.meshes = true;
    const MeshCasters casters = meshCasters(scene, info);
    ASSERT_EQ(casters.casters.size(), 2u);
    EXPECT_EQ(casters.casters[0].function.gradientTop, 3) << "its shadow has its colours";
}

TEST(DrawnScene, ProxiesDrawNoRegionsOfALayersOwnFunction) {
    Scene scene;
    scene.render.proxy = Proxy::Slices;
    scene.transfer["own"].kind = TransferKind::Regions;
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    EXPECT_TRUE(drawnByProxy(scene));
    scene.layers[0].transfer = "own";
    EXPECT_FALSE(drawnByProxy(scene));
}

} // namespace
} // namespace tessera::vis
