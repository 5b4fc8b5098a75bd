#include "vis/optics/surface_light.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace tessera::vis {

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

} // namespace tessera::vis
