#include "tests/packet/packet_pictures.h"

/// Looks drawn by packets of rays against the double-precision reference.
namespace tessera::vis::packet {
namespace {

Layer volumeIn(const char* channel, const Look& look) {
    return layerOf(VolumeLayer{.channel = channel, .density = 3, .look = look});
}
Layer surfaceIn(const char* channel, double value, const Look& look) {
    return layerOf(IsoLayer{.channel = channel, .value = value, .opacity = 0.8f, .look = look});
}

const Mode kInVolumes[] = {
    {"illustration",
     [](Scene& s) {
         Look look = *Look::preset("illustration");
         look.boundary = BoundaryEnhancement{};
         look.distance = DistanceColor{};
         s.layers = {volumeIn("a", look)};
     }},
    {"glass",
     [](Scene& s) {
         Look look = *Look::preset("glass");
         look.silhouette->ink = 0.5f;
         s.layers = {volumeIn("whole", look), surfaceIn("a", 317, look)};
         s.background = {1, 1, 1};
     }},
    {"stippled volume",
     [](Scene& s) {
         s.layers = {volumeIn("a", *Look::preset("stipple"))};
         s.transfer["a"].opacity = {{0, 0}, {0.5f, 0}, {0.8f, 0.8f}, {1, 0.8f}};
         s.background = {1, 1, 1};
     }},
    {"unlit",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .shaded = false, .look = *Look::preset("tone")})};
     }},
};

const Mode kOnSurfaces[] = {
    {"cartoon", [](Scene& s) { s.layers = {surfaceIn("a", 317, *Look::preset("cartoon"))}; }},
    {"charcoal",
     [](Scene& s) {
         s.layers = {surfaceIn("a", 317, *Look::preset("charcoal"))};
         s.background = {1, 1, 1};
     }},
    {"hatching",
     [](Scene& s) {
         Look look = *Look::preset("hatching");
         look.smooth = 1.5f;
         look.charcoal->crossing = 0.4f;
         look.charcoal->angle = 20;
         look.charcoal->grain = 6;
         s.layers = {surfaceIn("a", 317, look)};
         s.background = {1, 1, 1};
         s.lighting.lights = {Light{.kind = LightKind::Point, .position = {0.6f, 0.2f, 0.7f}}};
     }},
    {"rims where the box cuts",
     [](Scene& s) {
         Look look = *Look::preset("cartoon");
         look.cartoon->outline = 6;
         s.layers = {surfaceIn("a", 335, look)};
     }},
    {"wire", [](Scene& s) { s.layers = {surfaceIn("b", 0.5, *Look::preset("wire"))}; }},
    {"drawn context",
     [](Scene& s) {
         Look look = *Look::preset("cartoon");
         look.part = LookPart::Context;
         s.layers = {surfaceIn("parted", 4, look)};
         s.selection.brushes = {rangeBrush({{.channel = "whole", .lo = 0.6, .hi = 1.1, .soft = 0.2}})};
         s.selection.contextOpacity = 0.7f;
     }},
};

class PacketLooks : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketLooks, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketLooks, InVolumesAgreeWithTheReference) {
    expectAgreement(GetParam(), kInVolumes);
}

TEST_P(PacketLooks, OnSurfacesAgreeWithTheReference) {
    expectAgreement(GetParam(), kOnSurfaces);
}

} // namespace
} // namespace tessera::vis::packet
