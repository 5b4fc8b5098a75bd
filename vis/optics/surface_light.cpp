#include "vis/optics/surface_light.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace tessera::vis {

namespace {

/// Cosine between the normal and a direction, and the visibility of that side.
struct Incidence {
    double cosine = 0, share = 0;
};
Incidence incidence(const Facing& at, glm::dvec3 direction) {
    const double cosine = glm::dot(at.normal, direction);
    return {std::abs(cosine), cosine > 0 ? at.front : 1 - at.front};
}

/// Compensation for multiple scattering between microfacets, without which rough metal is too dark.
glm::dvec3 lost(glm::dvec3 straight, const Lighting& surface) {
    return 1.0 + straight * (1 / (1 - 0.5 * std::pow(double(surface.roughness), 3)) - 1);
}

} // namespace

glm::dvec3 lightDirection(const Light& light, const Camera& camera) {
    const double azimuth = glm::radians(double(light.azimuth)), elevation = glm::radians(double(light.elevation));
    const glm::dvec3 own(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                         std::cos(azimuth) * std::cos(elevation));
    if (light.kind == LightKind::World) return own;
    return glm::conjugate(glm::normalize(glm::dquat(camera.orientation))) * own;
}

std::vector<PlacedLight> placeLights(const Lighting& lighting, const Camera& camera, int limit) {
    std::vector<PlacedLight> placed;
    for (const Light& light : lighting.lights) {
        if (!light.enabled || placed.size() >= std::size_t(limit)) continue;
        const bool point = light.kind == LightKind::Point;
        placed.push_back({point, point ? glm::dvec3(light.position) : lightDirection(light, camera),
                          linearFromSrgb(glm::dvec3(light.color)) * double(light.intensity)});
    }
    return placed;
}

Facing facing(glm::dvec3 gradient, glm::dvec3 toViewer) {
    Facing at;
    at.normal = glm::normalize(gradient);
    at.toViewer = toViewer;
    at.front = std::clamp(0.5 + 0.5 * glm::dot(at.normal, toViewer) / kEdgeOn, 0.0, 1.0);
    return at;
}

glm::dvec3 phongLight(const Facing& at, glm::dvec3 albedo, glm::dvec3 toLight, const Lighting& surface) {
    const Incidence towards = incidence(at, toLight), glance = incidence(at, glm::normalize(at.toViewer + toLight));
    return albedo * (double(surface.diffuse) * towards.cosine * towards.share) +
           double(surface.specular) * std::pow(glance.cosine, double(surface.shininess)) * glance.share;
}

Reflected evenLight(const Facing& at, glm::dvec3 albedo, const Lighting& surface) {
    if (surface.model == LightModel::Phong) return {albedo, glm::dvec3(0)};
    const double nv = std::abs(glm::dot(at.normal, at.toViewer));
    const glm::dvec4 r =
        double(surface.roughness) * glm::dvec4(-1, -0.0275, -0.572, 0.022) + glm::dvec4(1, 0.0425, 1.04, -0.04);
    const double a = std::min(r.x * r.x, std::exp2(-9.28 * nv)) * r.x + r.y;
    const glm::dvec3 straight = glm::mix(glm::dvec3(surface.reflectance), albedo, double(surface.metalness));
    const glm::dvec3 mirrored =
        glm::min((straight * (-1.04 * a + r.z) + (1.04 * a + r.w)) * lost(straight, surface), glm::dvec3(1));
    return {(1.0 - mirrored) * (1.0 - double(surface.metalness)) * albedo, mirrored};
}

glm::dvec3 physicalLight(const Facing& at, glm::dvec3 albedo, const Reflected& even, glm::dvec3 toLight,
                         const Lighting& surface) {
    const glm::dvec3 half = glm::normalize(at.toViewer + toLight);
    const Incidence towards = incidence(at, toLight), glance = incidence(at, half);
    const double nl = towards.cosine, nh = glance.cosine;
    const double nv = std::max(std::abs(glm::dot(at.normal, at.toViewer)), 1e-3);
    const double alpha = double(surface.roughness) * surface.roughness, a2 = alpha * alpha;
    const double spread = nh * nh * (a2 - 1) + 1;
    const double distribution = a2 / (spread * spread); // without the factor 1 / pi
    const double visibility = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
    const glm::dvec3 straight = glm::mix(glm::dvec3(surface.reflectance), albedo, double(surface.metalness));
    const double edge = std::pow(1 - std::clamp(glm::dot(at.toViewer, half), 0.0, 1.0), 5);
    const glm::dvec3 fresnel = straight + (1.0 - straight) * edge;
    return nl * towards.share * (even.diffuse + distribution * visibility * fresnel * lost(straight, surface));
}

} // namespace tessera::vis
