#include "tests/packet/packet_pictures.h"

/// Parameters with several parts, whose samples are never mixed, by the packet ray caster.
namespace tessera::vis::packet {
namespace {

const Mode kPartModes[] = {
    {"an unlit volume",
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "parted", .shaded = false, .density = 0.3f})}; }},
    {"a lit volume", [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "parted", .density = 0.5f})}; }},
    {"surfaces",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "parted", .value = 6.2, .opacity = 0.7f}),
                     layerOf(IsoLayer{.channel = "parted", .value = 2.6, .opacity = 0.7f})};
     }},
    {"a single surface", [](Scene& s) { s.layers = {layerOf(IsoLayer{.channel = "parted", .value = 2.6})}; }},
    {"a maximum and a slice",
     [](Scene& s) {
         s.layers = {layerOf(SliceLayer{.channel = "parted", .contours = 4, .opacity = 0.6f}),
                     layerOf(VolumeLayer{.channel = "parted", .style = RayStyle::Maximum})};
         s.cursor = {9, 8, 12};
     }},
    {"gradient magnitudes",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "parted", .quantity = Quantity::Gradient, .density = 3})};
     }},
    {"brushes and colours",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .density = 0.5f, .colorBy = "parted"})};
         s.selection.brushes = {rangeBrush({{.channel = "parted", .lo = 5.5, .hi = 6.5, .soft = 0.3}})};
         s.selection.contextOpacity = 0.4f;
     }},
};

class PacketParts : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketParts, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketParts, AgreeWithTheReference) {
    expectAgreement(GetParam(), kPartModes);
}

} // namespace
} // namespace tessera::vis::packet
