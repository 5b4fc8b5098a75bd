#pragma once

#include "vis/optics/light_maps.h"
#include "vis/optics/light_volume.h"
#include "vis/optics/surface_light.h"
#include "volume/base/vectors.h"

#include <memory>
#include <type_traits>

/// Lighting of one sample by lights, cube maps and light volume. Templates over the number (volume/base/numbers.h).
/// Twin: vis/shaders/lib/shading/shade.glsl.
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
FlatShares flatShares(const Lighting& surface, std::span<const PlacedLight> lights);

/// The light of one picture, but for what is looked up at each sample.
struct ShadedBy {
    const Lighting* surface = nullptr;
    std::span<const PlacedLight> lights;
    bool maps = false, volume = false,
         scatters = false;   ///< what is looked up; `scatters`: light volume with that light
    FlatShares shares;       ///< with a light volume
    double cell = 0;         ///< longest edge of its cells
    glm::dmat3 fromWorld{1}; ///< to the axes of the maps

    /// Adds a light volume.
    void setVolume(const LightGrid& grid, bool withScattered);
};
ShadedBy shadedBy(const Illumination& light);

/// A lookup for pictures with neither maps nor a light volume.
struct NothingAround {};

/// Light that reaches a position: fractions of the first three lights and of ambient light, and scattered light.
template <class N> struct ReachingOf {
    glm::vec<3, N> lights{N(1), N(1), N(1)};
    N everywhere{1};
    glm::vec<3, N> scattered{N(0), N(0), N(0)};
};
template <class N, class Lookup>
ReachingOf<N> reachingLight(const ShadedBy& by, const Lookup& lookup, const glm::vec<3, N>& place) {
    const Shadows& shadows = by.surface->shadows;
    const glm::vec<4, N> seen = lookup.visible(place);
    ReachingOf<N> at;
    at.lights = blended(at.lights, glm::vec<3, N>(seen.x, seen.y, seen.z), N(shadows.strength));
    at.everywhere = blended(N(1), seen.w, N(shadows.occlusion));
    if (by.scatters) at.scattered = lookup.scattered(place);
    return at;
}

/// The part of uniform light that reaches a sample without a surface.
template <class N> N unshadowed(const FlatShares& shares, const ReachingOf<N>& reach) {
    return inner(spreadOut<N>(shares.lights), reach.lights) + reach.everywhere * N(shares.everywhere) + N(shares.rest);
}

/// Light from the maps that a surface reflects.
template <class N, class Lookup>
glm::vec<3, N> reflectedMaps(const ShadedBy& by, const Lookup& lookup, const FacingOf<N>& at,
                             const ReflectedOf<N>& even) {
    const auto turned = [&](const glm::vec<3, N>& v) {
        return spreadOut<N>(by.fromWorld[0]) * v.x + spreadOut<N>(by.fromWorld[1]) * v.y +
               spreadOut<N>(by.fromWorld[2]) * v.z;
    };
    const glm::vec<3, N> normal = turned(at.normal);
    const glm::vec<3, N> mirrored = turned(at.normal * (N(2) * inner(at.toViewer, at.normal)) - at.toViewer);
    const glm::vec<3, N> diffuse = blended(lookup.diffuse(-normal), lookup.diffuse(normal), at.front);
    const bool phong = by.surface->model == LightModel::Phong;
    const N mirrors(by.surface->specular);
    const glm::vec<3, N> specular = phong ? glm::vec<3, N>(mirrors, mirrors, mirrors) : even.specular;
    return even.diffuse * N(phong ? by.surface->diffuse : 1) * diffuse + specular * lookup.specular(mirrored);
}

/// The lit colour of a sample. `gradient` in world axes, any length. `weight` 0..1 blends from a sample without a
/// surface to the shaded one: 1 on iso-surfaces; in composite layers min(1, g / kFlatGradient), g the change over one
/// worldCell edge per axis (length of that vector), in transfer-function ranges. `place` in world space. `lookup` has
/// visible(place), scattered(place), diffuse(direction) and specular(direction) of what `by` says, or is NothingAround.
///
/// V_i, V_a = mix(1, fraction in the light volume, strength or occlusion), S its scattered light; 1, 1 and 0 without a
/// volume. They are looked up 1.5 light cells (of their longest edge) off the surface towards the viewer, weight (2
/// front - 1) times the normal, so that a surface does not shadow itself.
///   without surface: albedo (sum shares.lights_i V_i + shares.everywhere V_a + shares.rest + S)
///   shaded: V_a (ambient (even.diffuse + even.specular) + even.diffuse' D + even.specular' P) + albedo S + sum over
///           lights of V_i colour_i falloff_i phongLight or physicalLight; D = diffuse map at the normal (both sides
///           mixed by front), P = specular map at the mirrored direction; even' = even, for Phong albedo * diffuse and
///           specular.
template <class N, class Lookup>
glm::vec<3, N> shade(const ShadedBy& by, const Lookup& lookup, const glm::vec<3, N>& albedo,
                     const glm::vec<3, N>& gradient, N weight, const glm::vec<3, N>& place,
                     const glm::vec<3, N>& toViewer) {
    constexpr bool kAround = !std::is_same_v<Lookup, NothingAround>;
    const auto surface = (inner(gradient, gradient) > N(0)) & (weight > N(0));
    const bool any = anyOf(surface);
    weight = choose(surface, weight, N(0));
    FacingOf<N> at;
    if (any) at = facing(choose(surface, gradient, glm::vec<3, N>(N(0), N(0), N(1))), toViewer);
    ReachingOf<N> reach;
    glm::vec<3, N> flat = albedo;
    if constexpr (kAround) {
        if (by.volume) {
            const N off = (at.front - N(0.5)) * weight * N(3 * by.cell);
            reach = reachingLight(by, lookup, any ? place + at.normal * off : place);
            flat = albedo * (reach.scattered + unshadowed(by.shares, reach));
        }
    }
    if (!any) return flat;
    const ReflectedOf<N> even = evenLight(at, albedo, *by.surface);
    glm::vec<3, N> lit = (even.diffuse + even.specular) * N(by.surface->ambient);
    if constexpr (kAround) {
        if (by.maps) lit = lit + reflectedMaps(by, lookup, at, even);
        if (by.volume) lit = lit * reach.everywhere + albedo * reach.scattered;
    }
    const auto seen = [&](int i) { return kAround && i < kShadowLights ? reach.lights[i] : N(1); };
    lit = lit + reflectedLights<N>(by.lights, *by.surface, at, albedo, even, place, seen);
    return blended(flat, lit, weight);
}
glm::dvec3 shade(const Illumination& light, glm::dvec3 albedo, glm::dvec3 gradient, double weight, glm::dvec3 place,
                 glm::dvec3 toViewer);

} // namespace tessera::vis
