#include "tests/packet/packet_pictures.h"

/// What samples are coloured by: gradient magnitudes, other parameters, ranges without width.
namespace tessera::vis::packet {
namespace {

Layer gradientLayer(VolumeLayer volume) {
    volume.channel = "a";
    volume.quantity = Quantity::Gradient;
    return layerOf(volume);
}

const Mode kColorModes[] = {
    {"gradient magnitudes",
     [](Scene& s) {
         s.layers = {gradientLayer({.channel = {}, .density = 3})};
         s.transfer["a"].gradientTop = 0.15f;
     }},
    {"unshaded gradient magnitudes behind a surface",
     [](Scene& s) {
         s.layers = {gradientLayer({.channel = {}, .shaded = false, .density = 2}),
                     layerOf(IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.4f})};
     }},
    {"largest gradient",
     [](Scene& s) { s.layers = {gradientLayer({.channel = {}, .style = RayStyle::Maximum, .density = 5})}; }},
    {"absorbing gradients",
     [](Scene& s) { s.layers = {gradientLayer({.channel = {}, .style = RayStyle::XRay, .density = 3})}; }},
    {"a volume coloured by another parameter",
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3, .colorBy = "b"})}; }},
    {"unshaded, coloured by another parameter",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.5f, .colorBy = "a"})};
     }},
    {"a surface coloured by another parameter",
     [](Scene& s) {
         s.layers = {layerOf(IsoLayer{.channel = "whole", .value = 0.9, .opacity = 0.8f, .colorBy = "a"})};
     }},
    {"projections coloured by another parameter",
     [](Scene& s) {
         s.layers = {
             layerOf(VolumeLayer{.channel = "whole", .style = RayStyle::Average, .density = 0.6f, .colorBy = "b"}),
             layerOf(VolumeLayer{.channel = "b", .style = RayStyle::XRay, .density = 0.2f, .colorBy = "whole"}),
             layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .density = 0.5f, .colorBy = "whole"})};
     }},
    {"a maximum coloured by another parameter",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .colorBy = "whole"})};
     }},
    {"brushed, coloured by another parameter",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3, .colorBy = "whole"})};
         s.selection.brushes = {rangeBrush({{.channel = "b", .lo = 0.2, .hi = 0.6, .soft = 0.2}})};
         s.selection.contextSaturation = 0.2f;
     }},
    {"a constant parameter",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "even", .density = 0.4f}),
                     layerOf(SliceLayer{.channel = "even", .contours = 3, .opacity = 0.5f}),
                     layerOf(VolumeLayer{.channel = "even", .style = RayStyle::Maximum, .density = 0.4f})};
         s.cursor = {9, 8, 12};
     }},
    {"a constant parameter alone",
     [](Scene& s) { s.layers = {layerOf(VolumeLayer{.channel = "even", .shaded = false, .density = 0.5f})}; }},
    {"a range without width",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .shaded = false, .density = 0.6f})};
         s.transfer["whole"].autoRange = false;
         s.transfer["whole"].range = {0.8, 0.8};
         s.transfer["whole"].opacity = {{0, 0.1f}, {1, 0.6f}};
     }},
    {"lit above a range without width",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "whole", .density = 0.6f})};
         s.transfer["whole"].autoRange = false;
         s.transfer["whole"].range = {0.8, 0.8};
         s.transfer["whole"].opacity = {{0, 0}, {1, 0.6f}};
     }},
};

class PacketColors : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketColors, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketColors, AgreeWithTheReference) {
    expectAgreement(GetParam(), kColorModes);
}

} // namespace
} // namespace tessera::vis::packet
