#pragma once

#include "vis/scene/lighting.h"

#include <vector>

/// Reflection models: light that surfaces and samples send to the viewer.
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
/// Whether samples use cube maps.
inline bool usesMaps(const Lighting& lighting) {
    return lighting.inMaps || lighting.environment.kind != Environment::None;
}

/// A shading point: unit vectors in world axes. `front` is the visibility of the side that the normal points to: 1
/// facing the viewer, 0 facing away, blended while |n.v| < kEdgeOn, so that a gradient across the view direction, as at
/// the border of absent samples, does not cause light and dark patches. Light on the other side is weighted with 1 -
/// front.
struct Facing {
    glm::dvec3 normal{0, 0, 1}, toViewer{0, 0, 1};
    double front = 1;
};
Facing facing(glm::dvec3 gradient, glm::dvec3 toViewer);

/// Reflection of one light of colour 1 towards the viewer.
///   Phong: albedo diffuse n.l + specular (n.h)^shininess, h between l and v.
glm::dvec3 phongLight(const Facing& at, glm::dvec3 albedo, glm::dvec3 toLight, const Lighting& surface);
/// Reflection of uniform light of colour 1 from all directions: `diffuse` by scattering below the surface, and
/// `specular`.
///   Phong: the albedo, and 0.
///   Physical: specular = (F0 A + B) lost, A and B the fit of the GGX lobe's integral by Karis (Physically based
///   shading on mobile, 2014), lost = 1 + F0 (1 / (1 - roughness^3 / 2) - 1) the multiple scattering between
///   microfacets (fitted here; after Lagarde and Golubev after Turquin, Practical multiple scattering compensation for
///   microfacet models, 2018); F0 = mix(reflectance, albedo, metalness); diffuse = (1 - specular) (1 - metalness)
///   albedo, which conserves energy.
struct Reflected {
    glm::dvec3 diffuse{0}, specular{0};
};
Reflected evenLight(const Facing& at, glm::dvec3 albedo, const Lighting& surface);
/// Physical: n.l (diffuse + pi D V F lost), `diffuse` that of evenLight, F = F0 + (1 - F0) (1 - v.h)^5 (Schlick
///   1994), D and V of Trowbridge-Reitz (GGX) with alpha = roughness^2 and height-correlated masking (Heitz,
///   Understanding the masking-shadowing function, 2014). The factor pi: a light of intensity 1 has an irradiance of
///     pi.
glm::dvec3 physicalLight(const Facing& at, glm::dvec3 albedo, const Reflected& even, glm::dvec3 toLight,
                         const Lighting& surface);

} // namespace tessera::vis
