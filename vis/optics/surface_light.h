#pragma once

#include "vis/scene/lighting.h"
#include "volume/base/numbers.h"

#include <span>
#include <vector>

/// Reflection models: light that surfaces and samples send to the viewer. Formulas are templates over the number
/// (volume/base/numbers.h).
namespace tessera::vis {

inline constexpr double kEdgeOn = 0.25; ///< cosine to the viewer below which both sides are lit

/// A light in world axes.
struct PlacedLight {
    bool point = false;
    glm::dvec3 place{0, 0, 1}; ///< direction towards it (unit vector), or its position
    glm::dvec3 color{1};       ///< linear, times intensity
    bool operator==(const PlacedLight&) const = default;
};

/// Direction towards a directional light, in world axes, length 1.
glm::dvec3 lightDirection(const Light& light, const Camera& camera);
/// The first `limit` enabled lights.
std::vector<PlacedLight> placeLights(const Lighting& lighting, const Camera& camera, int limit = kMaxLights);
/// Those that samples are lit by one by one: none if they are in cube maps.
inline std::vector<PlacedLight> ownLights(const Lighting& lighting, const Camera& camera) {
    return lighting.inMaps ? std::vector<PlacedLight>() : placeLights(lighting, camera);
}
/// Whether samples use cube maps.
inline bool usesMaps(const Lighting& lighting) {
    return lighting.inMaps || lighting.environment.kind != Environment::None;
}

/// A shading point: unit vectors in world axes. `front` is the visibility of the side that the normal points to: 1
/// facing the viewer, 0 facing away, blended while |n.v| < kEdgeOn, so that a gradient across the view direction, as at
/// the border of absent samples, does not cause light and dark patches. Light on the other side is weighted with 1 -
/// front.
template <class N> struct FacingOf {
    glm::vec<3, N> normal{N(0), N(0), N(1)}, toViewer{N(0), N(0), N(1)};
    N front{1};
};
using Facing = FacingOf<double>;
template <class N> FacingOf<N> facing(const glm::vec<3, N>& gradient, const glm::vec<3, N>& toViewer) {
    FacingOf<N> at;
    at.normal = unit(gradient);
    at.toViewer = toViewer;
    at.front = clamped(N(0.5) + N(0.5 / kEdgeOn) * inner(at.normal, toViewer), N(0), N(1));
    return at;
}
inline Facing facing(glm::dvec3 gradient, glm::dvec3 toViewer) {
    return facing<double>(gradient, toViewer);
}

/// Cosine between the normal and a direction, and the visibility of that side.
template <class N> struct Incidence { N cosine, share; };
template <class N> Incidence<N> incidence(const FacingOf<N>& at, const glm::vec<3, N>& direction) {
    const N cosine = inner(at.normal, direction);
    return {magnitude(cosine), choose(cosine > N(0), at.front, N(1) - at.front)};
}

/// Reflection of one light of colour 1 towards the viewer.
///   Phong: albedo diffuse n.l + specular (n.h)^shininess, h between l and v.
template <class N>
glm::vec<3, N> phongLight(const FacingOf<N>& at, const glm::vec<3, N>& albedo, const glm::vec<3, N>& toLight,
                          const Lighting& surface) {
    const Incidence<N> towards = incidence(at, toLight), glance = incidence(at, unit(at.toViewer + toLight));
    const N diffuse = N(surface.diffuse) * towards.cosine * towards.share;
    const N specular = N(surface.specular) * power(glance.cosine, N(surface.shininess)) * glance.share;
    return albedo * diffuse + specular;
}
/// Reflection of uniform light of colour 1 from all directions: `diffuse` by scattering below the surface, and
/// `specular`.
///   Phong: the albedo, and 0.
///   Physical: specular = (F0 A + B) lost, A and B the fit of the GGX lobe's integral by Karis (Physically based
///   shading on mobile, 2014), lost = 1 + F0 (1 / (1 - roughness^3 / 2) - 1) the multiple scattering between
///   microfacets (fitted here; after Lagarde and Golubev after Turquin, Practical multiple scattering compensation for
///   microfacet models, 2018); F0 = mix(reflectance, albedo, metalness); diffuse = (1 - specular) (1 - metalness)
///   albedo, which conserves energy.
template <class N> struct ReflectedOf { glm::vec<3, N> diffuse, specular; };
using Reflected = ReflectedOf<double>;
/// F0 and the compensation for multiple scattering.
template <class N> ReflectedOf<N> straightAndLost(const glm::vec<3, N>& albedo, const Lighting& surface) {
    const double rough = double(surface.roughness), more = 1 / (1 - 0.5 * rough * rough * rough) - 1;
    const glm::vec<3, N> plain(N(surface.reflectance), N(surface.reflectance), N(surface.reflectance));
    const glm::vec<3, N> straight = blended(plain, albedo, N(surface.metalness));
    return {straight, straight * N(more) + N(1)};
}
template <class N>
ReflectedOf<N> evenLight(const FacingOf<N>& at, const glm::vec<3, N>& albedo, const Lighting& surface) {
    if (surface.model == LightModel::Phong) return {albedo, glm::vec<3, N>(N(0), N(0), N(0))};
    const N nv = magnitude(inner(at.normal, at.toViewer));
    const double rough = double(surface.roughness), x = 1 - rough, y = 0.0425 - 0.0275 * rough;
    const double z = 1.04 - 0.572 * rough, w = -0.04 + 0.022 * rough;
    const N a = smaller(N(x * x), powerOfTwo(N(-9.28) * nv)) * N(x) + N(y);
    const auto [straight, lost] = straightAndLost(albedo, surface);
    const N scale = N(-1.04) * a + N(z), shift = N(1.04) * a + N(w);
    const auto mirror = [&](N f0, N more) { return smaller((f0 * scale + shift) * more, N(1)); };
    const glm::vec<3, N> mirrored(mirror(straight.x, lost.x), mirror(straight.y, lost.y), mirror(straight.z, lost.z));
    const glm::vec<3, N> rest(N(1) - mirrored.x, N(1) - mirrored.y, N(1) - mirrored.z);
    return {rest * albedo * N(1.0 - double(surface.metalness)), mirrored};
}
/// Physical: n.l (diffuse + pi D V F lost), `diffuse` that of evenLight, F = F0 + (1 - F0) (1 - v.h)^5 (Schlick
///   1994), D and V of Trowbridge-Reitz (GGX) with alpha = roughness^2 and height-correlated masking (Heitz,
///   Understanding the masking-shadowing function, 2014). The factor pi: a light of intensity 1 has an irradiance of
///     pi.
template <class N>
glm::vec<3, N> physicalLight(const FacingOf<N>& at, const glm::vec<3, N>& albedo, const ReflectedOf<N>& even,
                             const glm::vec<3, N>& toLight, const Lighting& surface) {
    const glm::vec<3, N> half = unit(at.toViewer + toLight);
    const Incidence<N> towards = incidence(at, toLight), glance = incidence(at, half);
    const N nl = towards.cosine, nh = glance.cosine, nv = larger(magnitude(inner(at.normal, at.toViewer)), N(1e-3));
    const double alpha = double(surface.roughness) * double(surface.roughness);
    const N a2(alpha * alpha), rest(1 - alpha * alpha);
    const N spread = N(1) - nh * nh * rest;
    const N distribution = a2 / (spread * spread); // without the factor 1 / pi
    const N visibility = N(0.5) / (nl * squareRoot(nv * nv * rest + a2) + nv * squareRoot(nl * nl * rest + a2));
    const auto [straight, lost] = straightAndLost(albedo, surface);
    const N away = N(1) - clamped(inner(at.toViewer, half), N(0), N(1)), squared = away * away;
    const N edge = squared * squared * away;
    const glm::vec<3, N> more(N(1) - straight.x, N(1) - straight.y, N(1) - straight.z),
        fresnel = straight + more * edge;
    return (even.diffuse + fresnel * lost * (distribution * visibility)) * (nl * towards.share);
}

/// The sum over lights of V colour falloff phongLight or physicalLight, as shade() (vis/optics/shade.h) describes it;
/// `seen(i)` gives V of light i.
template <class N, class Seen>
glm::vec<3, N> reflectedLights(std::span<const PlacedLight> lights, const Lighting& surface, const FacingOf<N>& at,
                               const glm::vec<3, N>& albedo, const ReflectedOf<N>& even, const glm::vec<3, N>& place,
                               const Seen& seen) {
    glm::vec<3, N> lit(N(0), N(0), N(0));
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const PlacedLight& each = lights[i];
        glm::vec<3, N> toLight = spreadOut<N>(each.place);
        N strength = seen(int(i));
        if (each.point) {
            toLight = toLight - place;
            const N squared = inner(toLight, toLight);
            strength = strength / larger(squared, N(1e-4));
            toLight = toLight * (N(1) / squareRoot(larger(squared, N(1e-12))));
        }
        const glm::vec<3, N> own = surface.model == LightModel::Phong
                                       ? phongLight(at, albedo, toLight, surface)
                                       : physicalLight(at, albedo, even, toLight, surface);
        lit = lit + own * spreadOut<N>(each.color) * strength;
    }
    return lit;
}

} // namespace tessera::vis
