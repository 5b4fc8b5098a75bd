#include "tests/packet/packet_pictures.h"

/// Shadows and light from the surroundings drawn by packets of rays against the double-precision reference.
namespace tessera::vis::packet {
namespace {

Layer litVolume(const char* channel, bool shaded = true) {
    return layerOf(VolumeLayer{.channel = channel, .shaded = shaded, .density = 3});
}
Layer litSurface(const char* channel, double value, float opacity = 1) {
    return layerOf(IsoLayer{.channel = channel, .value = value, .color = {0.8f, 0.6f, 0.4f}, .opacity = opacity});
}

const Mode kWithShadows[] = {
    {"shadows of a volume",
     [](Scene& s) {
         s.layers = {litVolume("a")};
         s.lighting.shadows = {.strength = 0.8f, .resolution = 24};
     }},
    {"shadows of several lights on a surface",
     [](Scene& s) {
         s.layers = {litSurface("a", 317), litVolume("whole", false)};
         s.lighting.model = LightModel::Physical;
         s.lighting.lights = {
             Light{.kind = LightKind::World, .color = {1, 0.9f, 0.7f}, .azimuth = 60, .elevation = 20},
             Light{.kind = LightKind::Point, .color = {0.4f, 0.6f, 1}, .position = {0.6f, 0.2f, -0.4f}},
             Light{.intensity = 0.5f, .azimuth = -70}, Light{.intensity = 0.3f, .elevation = -30}};
         s.lighting.shadows = {.strength = 1, .resolution = 24};
     }},
    {"ambient occlusion",
     [](Scene& s) {
         s.layers = {litSurface("a", 317)};
         s.lighting.ambient = 0.7f;
         s.lighting.shadows = {.occlusion = 0.9f, .reach = 0.2f, .resolution = 37};
     }},
    {"translucency without surfaces",
     [](Scene& s) {
         s.layers = {litVolume("a", false)};
         s.lighting.shadows = {
             .strength = 0.7f, .occlusion = 0.3f, .translucency = 0.8f, .scatter = 0.6f, .resolution = 27};
     }},
    {"shadows of parts and labels",
     [](Scene& s) {
         s.layers = {litSurface("parted", 4, 0.8f), litVolume("label"), litVolume("parted")};
         s.transfer["label"].opacity = {{0, 0}, {0.3f, 0}, {0.31f, 0.2f}, {1, 0.2f}};
         s.transfer["parted"].opacity = {{0, 0}, {0.6f, 0}, {1, 0.1f}};
         s.lighting.shadows = {.strength = 1, .resolution = 24};
     }},
    {"shadows of what brushes, lenses and clips leave",
     [](Scene& s) {
         s.layers = {litVolume("a"), litSurface("whole", 0.9, 0.6f)};
         s.selection.brushes = {rangeBrush({{.channel = "b", .lo = 0.2, .hi = 0.9, .soft = 0.2}})};
         s.selection.contextOpacity = 0.2f;
         s.lenses = {
             Lens{.name = "one", .effect = LensEffect::Suppress, .center = {9, 8, 12}, .size = glm::vec3(0.25f)}};
         s.clips = {
             {.axis = {0.6f, 0.7f, 0.2f}},
             {.kind = ClipKind::Sphere, .keep = ClipKeep::Outside, .center = {0.4f, 0.3f, 0.6f}, .radius = 0.2f}};
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.5f, .resolution = 24};
     }},
    {"shadows in the colours of another channel",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3, .colorBy = "b"})};
         s.lighting.shadows = {.strength = 0.9f, .translucency = 0.5f, .resolution = 24};
     }},
    {"shadows behind a magnifying lens",
     [](Scene& s) {
         s.layers = {litVolume("a")};
         s.lenses = {
             Lens{.name = "near", .effect = LensEffect::Magnify, .center = {9, 8, 12}, .size = glm::vec3(0.3f)}};
         s.lighting.shadows = {.strength = 1, .resolution = 24};
     }},
    {"a look in shadows",
     [](Scene& s) {
         s.layers = {layerOf(VolumeLayer{.channel = "a", .density = 3, .look = *Look::preset("illustration")}),
                     layerOf(VolumeLayer{
                         .channel = "whole", .shaded = false, .density = 0.5f, .look = *Look::preset("glass")})};
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.6f, .resolution = 30};
     }},
};

const Mode kInSurroundings[] = {
    {"sky",
     [](Scene& s) {
         s.layers = {litSurface("a", 317)};
         s.lighting.environment = {.kind = Environment::Sky, .turn = 40};
     }},
    {"studio around a volume",
     [](Scene& s) {
         s.layers = {litVolume("a")};
         s.lighting.model = LightModel::Physical;
         s.lighting.roughness = 0.4f;
         s.lighting.metalness = 0.6f;
         s.lighting.environment = {.kind = Environment::Studio, .follows = true};
     }},
    {"lamps in maps",
     [](Scene& s) {
         s.layers = {litSurface("a", 317)};
         s.lighting.inMaps = true;
         s.lighting.lights = {Light{.azimuth = 50}, Light{.color = {1, 0.3f, 0.2f}, .azimuth = -80, .elevation = 70},
                              Light{.kind = LightKind::Point, .position = {0.6f, 0.2f, -0.4f}}};
     }},
    {"a picture, with ambient occlusion",
     [](Scene& s) {
         s.layers = {litSurface("a", 317)};
         s.lighting.model = LightModel::Physical;
         s.lighting.lights = {};
         s.lighting.ambient = 0;
         s.lighting.roughness = 0.22f;
         s.lighting.metalness = 0.35f;
         s.lighting.environment.kind = Environment::Picture;
         s.lighting.shadows = {.occlusion = 0.6f, .resolution = 24};
     }},
};

std::shared_ptr<const CubeMap> stripes() {
    auto map = std::make_shared<CubeMap>();
    map->edge = 16;
    map->texels.resize(6 * 16 * 16);
    for (std::size_t i = 0; i < map->texels.size(); ++i) {
        const glm::dvec3 d = map->texelDirection(i);
        map->texels[i] = glm::dvec3(0.6 + 0.5 * std::sin(7 * d.x), 0.5 + 0.4 * d.y, 0.5 + 0.4 * std::cos(5 * d.z));
    }
    return map;
}

class PacketLightTest : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, PacketLightTest, testing::ValuesIn(cases()), nameOf);

TEST_P(PacketLightTest, ShadowsAgreeWithTheReference) {
    expectAgreement(GetParam(), kWithShadows);
}

TEST_P(PacketLightTest, SurroundingsAgreeWithTheReference) {
    expectAgreement(source(GetParam().kind, GetParam().masked), kInSurroundings, stripes());
}

} // namespace
} // namespace tessera::vis::packet
