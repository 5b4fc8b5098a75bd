#pragma once

#include "vis/optics/light_maps.h"
#include "vis/optics/light_volume.h"
#include "vis/optics/surface_light.h"

#include <memory>

/// Lighting of one sample by lights, cube maps and light volume. Twin: vis/shaders/lib/shade.glsl.
namespace tessera::vis {

/// The light of one picture.
struct Illumination {
    Lighting surface;
    std::vector<PlacedLight> lights;                   ///< lights evaluated individually; none if they are in maps
    std::shared_ptr<const LightMaps> maps;             ///< null: none
    std::shared_ptr<const LightVolume<double>> volume; ///< null: none
};
/// The lights and maps of a lighting; the caller adds the volume. `picture`: see environmentMaps().
Illumination illuminate(const Lighting& lighting, const Camera& camera, const CubeMap* picture = nullptr);

/// Fractions of the uniform light in a sample without a surface: of the first three lights (by luminance times 1 - a),
/// of ambient light (a), and of unshadowed light; they sum to 1. a = ambient / (ambient + diffuse), physical: ambient /
/// (ambient + 1).
struct FlatShares {
    glm::dvec3 lights{0};
    double everywhere = 0, rest = 1;
};
FlatShares flatShares(const Illumination& light);

/// The lit colour of a sample. `gradient` in world axes, any length. `weight` 0..1 blends from a sample without a
/// surface to the shaded one: 1 on iso-surfaces; in composite layers min(1, g / kFlatGradient), g the change over one
/// worldCell edge per axis (length of that vector), in transfer-function ranges. `place` in world space.
///
/// V_i, V_a = mix(1, fraction in the light volume, strength or occlusion), S its scattered light; 1, 1 and 0 without a
/// volume. They are looked up 1.5 light cells (of their longest edge) off the surface towards the viewer, weight (2
/// front - 1) times the normal, so that a surface does not shadow itself.
///   without surface: albedo (sum shares.lights_i V_i + shares.everywhere V_a + shares.rest + S)
///   shaded: V_a (ambient (even.diffuse + even.specular) + even.diffuse' D + even.specular' P) + albedo S + sum over
///           lights of V_i colour_i falloff_i phongLight or physicalLight; D = diffuse map at the normal (both sides
///           mixed by front), P = specular map at the mirrored direction; even' = even, for Phong albedo * diffuse and
///           specular.
glm::dvec3 shade(const Illumination& light, glm::dvec3 albedo, glm::dvec3 gradient, double weight, glm::dvec3 place,
                 glm::dvec3 toViewer);

} // namespace tessera::vis
