#pragma once

#include "vis/scene/camera.h"

#include <optional>
#include <string>
#include <vector>

/// Lighting of surfaces and samples: lights and reflection models; the formulas are in vis/optics/surface_light.h
/// (double) and vis/shaders/lib/shading/lighting.glsl (float).
///
/// All light is linear. A light of intensity 1 at normal incidence makes a white Lambertian surface 1. Colours of
/// lights are sRGB and converted to linear light first.
namespace tessera::vis {

enum class LightKind { Viewer, World, Point };
inline constexpr std::string_view kLightKindNames[] = {"viewer", "world", "point"};

/// One light. `viewer` and `world` lights are directional; their direction is given in the viewer's axes, or in the
/// data's, where azimuth 0 and elevation 0 is +z and elevation 90 is +y. A point light is at `position` (world, longest
/// edge of the box = 1, its centre = 0) and attenuated by the squared distance, from 1 at distance 1.
struct Light {
    bool enabled = true;
    LightKind kind = LightKind::Viewer;
    glm::vec3 color{1}; ///< sRGB
    float intensity = 1;
    float azimuth = -30, elevation = 40; ///< degrees
    glm::vec3 position{-0.5f, 1, 1};

    bool operator==(const Light&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.enabled, FieldInfo{"enabled", "The light is on"});
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "Kind of light: a distant light that turns with the viewer or is fixed to "
                                          "the data, or a point light",
                                   .names = kLightKindNames});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour (sRGB)", .range = Range{0, 1}});
        visit(
            self.intensity,
            FieldInfo{.key = "intensity", .doc = "Brightness; 1 shows white surfaces as white", .range = Range{0, 20}});
        visit(self.azimuth, FieldInfo{.key = "azimuth",
                                      .doc = "Angle to the right of the viewer, or of the z axis",
                                      .unit = "deg",
                                      .range = Range{-180, 180},
                                      .applies = self.kind != LightKind::Point});
        visit(self.elevation, FieldInfo{.key = "elevation",
                                        .doc = "Angle above the viewer, or towards the y axis",
                                        .unit = "deg",
                                        .range = Range{-90, 90},
                                        .applies = self.kind != LightKind::Point});
        visit(self.position, FieldInfo{.key = "position",
                                       .doc = "Distance of a point light from the centre; longest edge of the data = 1",
                                       .range = Range{-10, 10},
                                       .applies = self.kind == LightKind::Point});
    }
};

enum class Environment { None, Sky, Studio, SoftBox, Picture };
inline constexpr std::string_view kEnvironmentNames[] = {"none", "sky", "studio", "softBox", "picture"};

/// Light from the environment (vis/optics/light_maps.h).
struct EnvironmentLight {
    Environment kind = Environment::None;
    std::string picture = {}; ///< file of Environment::Picture (vis/image/light_picture.h)
    float strength = 1, reflection = 1;
    float turn = 0;       ///< degrees
    bool follows = false; ///< rotates with the viewer
    bool operator==(const EnvironmentLight&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "Surroundings that light the scene and are reflected in it",
                                   .names = kEnvironmentNames});
        visit(self.picture,
              FieldInfo{.key = "picture",
                        .doc = "Picture of the surroundings for kind \"picture\", Radiance (.hdr) or PNG: a panorama "
                               "of 2:1 with its middle behind the data, or a cube map cross of 4:3 or 3:4",
                        .refersTo = "path",
                        .applies = self.kind == Environment::Picture});
        visit(self.strength, FieldInfo{.key = "strength",
                                       .doc = "Brightness of the surroundings",
                                       .range = Range{0, 5},
                                       .applies = self.kind != Environment::None});
        visit(self.reflection, FieldInfo{.key = "reflection",
                                         .doc = "Strength of reflections of the surroundings",
                                         .range = Range{0, 4},
                                         .applies = self.kind != Environment::None});
        visit(self.turn, FieldInfo{.key = "turn",
                                   .doc = "Rotation of the surroundings around the vertical axis",
                                   .unit = "deg",
                                   .range = Range{-180, 180},
                                   .applies = self.kind != Environment::None});
        visit(self.follows, FieldInfo{.key = "follows",
                                      .doc = "The surroundings turn with the viewer",
                                      .applies = self.kind != Environment::None});
    }
};

/// Shadows, ambient occlusion and translucency (vis/optics/light_volume.h); all off by default.
struct Shadows {
    float strength = 0;     ///< strength of shadows
    float occlusion = 0;    ///< strength of ambient occlusion
    float reach = 0.12f;    ///< world: range of ambient occlusion
    float translucency = 0; ///< fraction of light scattered forward, coloured by the medium
    float scatter = 0.5f;   ///< softness of that light
    bool meshes = true;     ///< meshes cast shadows too
    int resolution = 64;    ///< light grid cells along the longest edge
    bool any() const { return strength > 0 || occlusion > 0 || translucency > 0; }
    bool operator==(const Shadows&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.strength, FieldInfo{.key = "strength",
                                       .doc = "Darkness of the shadows of the first three lights; 0 = none",
                                       .range = Range{0, 1}});
        visit(self.occlusion, FieldInfo{.key = "occlusion",
                                        .doc = "Ambient occlusion, the darkening of hollows; 0 = none",
                                        .range = Range{0, 1}});
        visit(self.reach, FieldInfo{.key = "reach",
                                    .doc = "Radius of ambient occlusion; longest edge of the data = 1",
                                    .range = Range{0.01, 1},
                                    .logScale = true,
                                    .applies = self.occlusion > 0});
        visit(self.translucency,
              FieldInfo{.key = "translucency",
                        .doc = "Translucency: light that passes through the volume and takes its colour; 0 = none",
                        .range = Range{0, 1}});
        visit(self.scatter, FieldInfo{.key = "scatter",
                                      .doc = "How far translucent light spreads sideways",
                                      .range = Range{0, 1},
                                      .applies = self.translucency > 0});
        visit(self.meshes, FieldInfo{.key = "meshes",
                                     .doc = "Polygon surfaces cast shadows on volumes and on each other",
                                     .applies = self.any()});
        visit(self.resolution, FieldInfo{.key = "resolution",
                                         .doc = "Cells of the light volume along the longest edge",
                                         .range = Range{16, 128},
                                         .applies = self.any()});
    }
};

enum class LightModel { Phong, Physical };
inline constexpr std::string_view kLightModelNames[] = {"phong", "physical"};

struct Lighting {
    LightModel model = LightModel::Phong;
    std::vector<Light> lights = std::vector<Light>(1);
    bool inMaps = false; ///< the lights are added to the cube maps
    EnvironmentLight environment;
    Shadows shadows;
    float ambient = 0.25f;
    float diffuse = 0.65f, specular = 0.25f, shininess = 30;       ///< of Phong
    float roughness = 0.4f, metalness = 0.0f, reflectance = 0.04f; ///< of the physical model

    bool operator==(const Lighting&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kSurface = "Reflection";
        visit(self.model, FieldInfo{.key = "model",
                                    .doc = "Reflection model: Phong, or a physical one (GGX microfacets over a Lambert "
                                           "base, energy conserving)",
                                    .names = kLightModelNames});
        visit(self.ambient, FieldInfo{.key = "ambient", .doc = "Ambient light", .range = Range{0, 1}});
        visit(self.lights, FieldInfo{"lights", "Lights; up to 16, or any number with `inMaps`"});
        visit(self.inMaps,
              FieldInfo{"inMaps", "Combine all lights in cube maps: any number at the cost of one, without shadows"});
        visit(self.environment, FieldInfo{"environment", "Light from the surroundings"});
        visit(self.shadows, FieldInfo{"shadows", "Shadows, ambient occlusion, translucency"});
        visit(self.diffuse, FieldInfo{.key = "diffuse",
                                      .doc = "Diffuse reflection (Phong)",
                                      .range = Range{0, 1},
                                      .applies = self.model == LightModel::Phong,
                                      .group = kSurface});
        visit(self.specular, FieldInfo{.key = "specular",
                                       .doc = "Specular reflection (Phong)",
                                       .range = Range{0, 1},
                                       .applies = self.model == LightModel::Phong,
                                       .group = kSurface});
        visit(self.shininess, FieldInfo{.key = "shininess",
                                        .doc = "Phong exponent",
                                        .range = Range{1, 200},
                                        .logScale = true,
                                        .applies = self.model == LightModel::Phong,
                                        .group = kSurface});
        visit(self.roughness, FieldInfo{.key = "roughness",
                                        .doc = "Roughness of the surface: 0.05 polished, 1 dull (physical)",
                                        .range = Range{0.05, 1},
                                        .applies = self.model == LightModel::Physical,
                                        .group = kSurface});
        visit(self.metalness, FieldInfo{.key = "metalness",
                                        .doc = "Metalness: 1 reflects in the colour of the surface (physical)",
                                        .range = Range{0, 1},
                                        .applies = self.model == LightModel::Physical,
                                        .group = kSurface});
        visit(self.reflectance,
              FieldInfo{.key = "reflectance",
                        .doc = "Share of light reflected at normal incidence: 0.04 plastic, 0.17 gem (physical)",
                        .range = Range{0, 1},
                        .applies = self.model == LightModel::Physical,
                        .group = kSurface});
    }
};

inline constexpr int kMaxLights = 16; ///< MAX_LIGHTS of the shader; further ones are ignored

} // namespace tessera::vis
