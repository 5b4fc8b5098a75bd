#include "tests/packet/packet_pictures.h"

/// Labels by the packet ray caster: each place shows the nearest sample.
namespace tessera::vis::packet {
namespace {

void colorLabels(Scene& scene) {
    TransferFunction& function = scene.transfer["label"];
    function.opacity = {{0, 0.02f}, {0.2f, 0.02f}, {0.4f, 0.2f}, {0.6f, 0}, {1, 0.3f}};
    function.colors = {{0, {0.9f, 0.2f, 0.1f}}, {0.4f, {0.2f, 0.8f, 0.3f}}, {1, {0.1f, 0.3f, 0.9f}}};
}

const Mode kLabelModes[] = {
    {"a volume",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "label", .density = 0.6f})};
         colorLabels(s);
     }},
    {"by a colour map of names",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "label", .shaded = false, .density = 0.4f})};
         s.transfer["label"].colormap = "labels";
     }},
    {"slices and a surface",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{.channel = "label", .opacity = 0.8f}),
                     layerOf(IsoLayer{.channel = "label", .value = 2.5, .opacity = 0.6f})};
         s.cursor = {9, 8, 12};
         colorLabels(s);
     }},
    {"the largest",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "label", .style = RayStyle::Maximum, .density = 2})};
         colorLabels(s);
     }},
    {"colours of a surface",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.8f, .colorBy = "label"})};
         colorLabels(s);
     }},
    {"brushed by name",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f})};
         s.selection.brushes = {rangeBrush({{.channel = "label", .lo = 2, .hi = 2}}),
                                rangeBrush({{.channel = "label", .lo = 4, .hi = 4}})};
         s.selection.brushes[1].combine = BrushCombine::Or;
         s.selection.contextOpacity = 0.1f;
     }},
    {"behind a magnifying lens",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "label", .density = 0.6f})};
         s.lenses = {{.name = "magnifier",
                      .effect = LensEffect::Magnify,
                      .center = {9, 8, 12},
                      .size = glm::vec3(0.25f),
                      .magnification = 2.5f}};
         colorLabels(s);
     }},
};

class PacketLabels : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketLabels, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketLabels, AgreeWithTheReference) {
    expectAgreement(GetParam(), kLabelModes);
}

} // namespace
} // namespace tessera::vis::packet
