#include "tests/packet/packet_pictures.h"
#include "tests/reference/some_strokes.h"

/// Slices by the packet ray caster, alone and among other layers, against the double-precision reference.
namespace tessera::vis::packet {
namespace {

const Mode kSliceModes[] = {
    {"slices",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{
                         .channel = "a", .orientation = SliceOrientation::Oblique, .normal = {0.5f, 0.7f, 0.3f}}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::Y, .opacity = 0.6f}),
                     layerOf(SliceLayer{.channel = "whole", .atCursor = false, .position = 1, .opacity = 0.3f})};
         s.cursor = {9, 8, 12};
     }},
    {"contour lines",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{.channel = "a",
                                        .orientation = SliceOrientation::Oblique,
                                        .normal = {0.2f, 0.4f, 0.9f},
                                        .contours = 4,
                                        .opacity = 0.9f})};
         s.cursor = {9, 8, 12};
     }},
    {"strokes",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{.channel = "a", .orientation = SliceOrientation::X, .contours = 2}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::Z, .opacity = 0.7f}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::Y})};
         std::get<SliceLayer>(s.layers[0].technique).strokes.strength = 0.8f;
         std::get<SliceLayer>(s.layers[1].technique).strokes.grey = true;
         s.strokes = {{0, reference::someStrokes({0, 1, 0}, {0, 0, 1})},
                      {1, reference::someStrokes({0.6, 0.8, 0}, {-0.8, 0.6, 0})}};
         s.cursor = {9, 8, 12};
     }},
    {"slices in a haze",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::X, .opacity = 0.4f}),
                     layerOf(SliceLayer{
                         .channel = "a", .orientation = SliceOrientation::Oblique, .normal = {-0.5f, 0.7f, 0.3f}}),
                     layerOf(SliceLayer{.channel = "b", .atCursor = false, .position = 0.2, .opacity = 0.5f})};
         s.cursor = {9, 8, 12};
     }},
    {"slices in a lit volume",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::X, .opacity = 0.5f}),
                     layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(SliceLayer{.channel = "b", .opacity = 0.7f})};
         s.cursor = {9, 8, 12};
         s.clips = {{.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f},
                    {.kind = ClipKind::Box, .size = {0.8f, 0.7f, 0.85f}}};
     }},
    {"slices and a surface",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "a", .value = 317, .opacity = 0.5f}),
                     layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::X, .opacity = 0.5f}),
                     layerOf(SliceLayer{.channel = "b", .opacity = 0.7f})};
         s.cursor = {9, 8, 12};
     }},
    {"a maximum behind slices",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum}),
                     layerOf(SliceLayer{.channel = "a", .orientation = SliceOrientation::X, .opacity = 0.4f}),
                     layerOf(SliceLayer{.channel = "whole", .opacity = 0.8f})};
         s.cursor = {9, 8, 12};
     }},
    {"all kinds of layers",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a"}),
                     layerOf(IsoLayer{.channel = "b", .value = 0.55, .color = {0.2f, 0.5f, 0.9f}, .opacity = 0.5f}),
                     layerOf(SliceLayer{.channel = "whole", .orientation = SliceOrientation::X, .opacity = 0.4f}),
                     layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Average, .density = 0.5f}),
                     layerOf(SliceLayer{.channel = "a", .opacity = 1})};
         s.cursor = {9, 8, 12};
     }},
    {"slices under brushes and lenses",
     [](Scene& s) {
         s.layers = {
             layerOf(
                 SliceLayer{.channel = "a", .orientation = SliceOrientation::Oblique, .normal = {0.5f, 0.7f, 0.3f}}),
             layerOf(SliceLayer{.channel = "b", .orientation = SliceOrientation::X, .contours = 2, .opacity = 0.6f}),
             layerOf(VolumeLayer{.channel = "a"})};
         s.layers[1].lens = "window";
         s.layers[2].brushes = BrushEffect::FocusOnly;
         s.cursor = {9, 8, 12};
         s.lenses = {{.name = "window", .center = {8, 7, 10}, .size = glm::vec3(0.3f), .rim = 0.3f}};
         s.selection.brushes = {rangeBrush({{.channel = "b", .lo = 0.2, .hi = 0.5, .soft = 0.2}})};
         s.selection.contextOpacity = 0.3f;
         s.selection.contextSaturation = 0.2f;
     }},
};

class PacketSlices : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketSlices, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketSlices, AgreeWithTheReference) {
    expectAgreement(GetParam(), kSliceModes);
}

/// Where slices lie, how opaque they are and what lines they have changes nothing of what a scene is prepared for.
TEST(PacketSlicesMore, FollowTheScene) {
    const auto data = source(LatticeKind::CC, false);
    PacketRenderer renderer;
    renderer.setSource(data);
    Scene scene = wavyScene(true);
    scene.layers = {layerOf(VolumeLayer{.channel = "a"}), layerOf(SliceLayer{.channel = "b"})};
    auto& slice = std::get<SliceLayer>(scene.layers[1].technique);
    const auto check = [&](const char* what) {
        const reference::Image got = asImage(renderer.render(scene, kSize)),
                               wanted = reference::render(scene, *data, kSize);
        const reference::Difference apart = reference::compare(got, wanted, kOutlier);
        EXPECT_LE(apart.beyond, kOutliers) << what;
        EXPECT_LE(apart.rmseWithin, std::pow(10, -kPsnr / 20)) << what;
    };
    scene.cursor = {9, 8, 12};
    check("at the cross-hair");
    scene.cursor = {4, 3, 5};
    check("it moved");
    slice.atCursor = false;
    slice.orientation = SliceOrientation::Oblique;
    slice.normal = {0.3f, 0.8f, 0.4f};
    check("turned");
    slice.opacity = 0.4f;
    slice.contours = 3;
    check("fainter, with lines");
    slice.channel = "a";
    check("of another parameter");
    scene.layers[1].visible = false;
    check("hidden");
}

} // namespace
} // namespace tessera::vis::packet
