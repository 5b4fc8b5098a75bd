#include "tests/packet/packet_pictures.h"

/// Magnifying lenses by the packet ray caster.
namespace tessera::vis::packet {
namespace {

Lens magnifier(LensShape shape, glm::dvec3 center, glm::vec3 size) {
    return {.name = "magnifier",
            .shape = shape,
            .effect = LensEffect::Magnify,
            .center = center,
            .size = size,
            .magnification = 2.5f};
}

const Mode kMagnifyModes[] = {
    {"a lit volume",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3})};
         s.lenses = {magnifier(LensShape::Sphere, {9, 8, 12}, glm::vec3(0.25f))};
     }},
    {"an unlit volume and a projection",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false}),
                     layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .density = 0.5f})};
         s.lenses = {magnifier(LensShape::Box, {7, 8, 14}, {0.25f, 0.2f, 0.3f})};
         s.lenses[0].rotation = {20, 30, 10};
     }},
    {"a surface and slices",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.7f}),
                     layerOf(SliceLayer{.channel = "b", .opacity = 0.8f})};
         s.cursor = {9, 8, 12};
         s.lenses = {magnifier(LensShape::Disc, {9, 8, 12}, glm::vec3(0.2f))};
     }},
    {"two of them, brushes in space, and a window",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3}),
                     layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f})};
         s.layers[1].lens = "window";
         s.lenses = {magnifier(LensShape::Sphere, {6, 8, 8}, glm::vec3(0.2f)),
                     magnifier(LensShape::Cylinder, {12, 9, 16}, {0.2f, 0.2f, 0.15f}),
                     {.name = "window", .center = {8, 7, 14}, .size = glm::vec3(0.2f), .rim = 0.3f}};
         Brush sphere{.name = "sphere", .region = {}};
         sphere.region = SphereRegion{.center = {9, 8, 12}, .radius = {6, 5, 7}, .soft = 0.4};
         s.selection.brushes = {sphere, rangeBrush({{.channel = "a", .lo = 285, .hi = 330, .soft = 20}})};
     }},
};

class PacketMagnify : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketMagnify, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketMagnify, AgreesWithTheReference) {
    expectAgreement(GetParam(), kMagnifyModes);
}

} // namespace
} // namespace tessera::vis::packet
