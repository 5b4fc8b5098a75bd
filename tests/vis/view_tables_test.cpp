#include "vis/view/view_tables.h"

#include "vis/gl/shader_constants.h"

#include <functional>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

volume::DatasetInfo oneChannel() {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.parameters.resize(1);
    info.parameters[0].name = "a";
    return info;
}

Scene sceneWithLens() {
    Scene scene;
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
    scene.lenses = {{.name = "lens"}};
    return scene;
}

/// Whether tables are made anew when a scene changes so.
bool anew(const Scene& before, const std::function<void(Scene&)>& change) {
    Scene after = before;
    change(after);
    EXPECT_FALSE(after == before) << "nothing was changed";
    return !(tablesScene(after, oneChannel()) == tablesScene(before, oneChannel()));
}

TEST(TablesScene, WhatMovesThePictureAloneKeepsTheTables) {
    const Scene scene = sceneWithLens();
    for (const auto& change : std::initializer_list<std::function<void(Scene&)>>{
             [](Scene& s) { s.camera.distance += 1; }, [](Scene& s) { s.cursor.x += 1; },
             [](Scene& s) { s.lighting.shadows.strength = 0.5f; }, [](Scene& s) { s.lenses[0].center.x += 1; },
             [](Scene& s) { s.lenses[0].shape = LensShape::Disc; }, [](Scene& s) { s.render.samples = 9; },
             [](Scene& s) { s.render.stepVoxels = 0.25f; }, [](Scene& s) { s.tone.exposure = 1; },
             [](Scene& s) { s.clips.resize(1); }, [](Scene& s) { s.showBox = false; }})
        EXPECT_FALSE(anew(scene, change));
}

TEST(TablesScene, WhatTablesAreMadeOfMakesThemAnew) {
    const Scene scene = sceneWithLens();
    for (const auto& change : std::initializer_list<std::function<void(Scene&)>>{
             [](Scene& s) { s.layers[0].visible = false; }, [](Scene& s) { s.layers[0].brushes = BrushEffect::None; },
             [](Scene& s) {
                 s.transfer["a"].opacity = {{0, 1}, {1, 0}};
             },
             [](Scene& s) { s.selection.contextOpacity = 0; }, [](Scene& s) { s.stretch.z = 2; },
             [](Scene& s) { s.render.filter = Filter::Tetrahedral; }, [](Scene& s) { s.lenses[0].enabled = false; },
             [](Scene& s) { s.lenses[0].effect = LensEffect::Focus; }, [](Scene& s) { s.lenses[0].name = "other"; }})
        EXPECT_TRUE(anew(scene, change));
    // A lens that does not act at a time is as one that is off.
    EXPECT_TRUE(anew(scene, [](Scene& s) { s.lenses[0].fromTime = s.time + 1; }));
    // Longer steps are in the tables where a scene has them.
    Scene adaptive = scene;
    adaptive.lenses.clear();
    adaptive.render.adaptiveStep = 0.01f;
    EXPECT_TRUE(anew(adaptive, [](Scene& s) { s.render.stepVoxels = 0.25f; }));
    EXPECT_TRUE(anew(adaptive, [](Scene& s) { s.lighting.shadows.strength = 0.5f; })) << "steps are all alike then";
}

TEST(ShaderConstants, EveryEnumeratorHasItsNumber) {
    const std::string text = '\n' + shaderConstants();
    for (const auto& [name, number] : {std::pair{"STYLE_COMPOSITE", int(RayStyle::Composite)},
                                       {"STYLE_LOCALMAXIMUM", int(RayStyle::LocalMaximum)},
                                       {"STYLE_ISO", int(RayStyle::Iso)},
                                       {"LOOKUP_SLAB", int(RayLookup::Slab)},
                                       {"LENS_SHAPE_DISC", int(LensShape::Disc)},
                                       {"CLIP_KIND_CYLINDER", int(ClipKind::Cylinder)},
                                       {"BRUSHED_CONTEXT", int(BrushEffect::ContextOnly)},
                                       {"BRUSHED_FOCUS", int(BrushEffect::FocusOnly)},
                                       {"BRUSH_TEST_LENS", int(BrushTestKind::Lens)},
                                       {"TONE_CURVE_FILMIC", int(ToneCurve::Filmic)},
                                       {"LOOK_TONE", bitOf(LookFeature::Tone)},
                                       {"LOOK_WIRE", bitOf(LookFeature::Wire)}})
        EXPECT_NE(text.find("\n#define " + std::string(name) + ' ' + std::to_string(number) + '\n'), std::string::npos)
            << name;
}

} // namespace
} // namespace tessera::vis
