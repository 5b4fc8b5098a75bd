#include "vis/optics/shade.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

/// Light that reaches a position.
struct Reaching {
    glm::dvec3 lights{1};
    double everywhere = 1;
    glm::dvec3 scattered{0};
};
Reaching reaching(const Illumination& light, glm::dvec3 place) {
    Reaching at;
    if (!light.volume) return at;
    const Shadows& shadows = light.surface.shadows;
    const glm::dvec4 seen = light.volume->visibleAt(place);
    at.lights = glm::mix(glm::dvec3(1), glm::dvec3(seen), double(shadows.strength));
    at.everywhere = glm::mix(1.0, seen.a, double(shadows.occlusion));
    at.scattered = light.volume->scatteredAt(place);
    return at;
}

} // namespace

Illumination illuminate(const Lighting& lighting, const Camera& camera, const CubeMap* picture) {
    Illumination light;
    light.surface = lighting;
    if (!lighting.inMaps) light.lights = placeLights(lighting, camera);
    if (usesMaps(lighting))
        light.maps = std::make_shared<const LightMaps>(lightMaps(lighting, camera, environmentMaps(lighting, picture)));
    return light;
}

FlatShares flatShares(const Illumination& light) {
    FlatShares shares;
    const double ambient = light.surface.ambient,
                 others = light.surface.model == LightModel::Phong ? double(light.surface.diffuse) : 1;
    shares.everywhere = ambient + others > 0 ? ambient / (ambient + others) : 0;
    double sum = 0;
    for (const PlacedLight& each : light.lights) sum += luminance(each.color);
    double hidden = 0;
    for (std::size_t i = 0; i < light.lights.size() && i < std::size_t(kShadowLights) && sum > 0; ++i) {
        shares.lights[int(i)] = (1 - shares.everywhere) * luminance(light.lights[i].color) / sum;
        hidden += shares.lights[int(i)];
    }
    shares.rest = 1 - shares.everywhere - hidden;
    return shares;
}

glm::dvec3 shade(const Illumination& light, glm::dvec3 albedo, glm::dvec3 gradient, double weight, glm::dvec3 place,
                 glm::dvec3 toViewer) {
    const bool surface = glm::length(gradient) > 0 && weight > 0;
    const Facing at = surface ? facing(gradient, toViewer) : Facing{};
    glm::dvec3 looked = place;
    if (surface && light.volume) {
        const glm::dvec3 cell = light.volume->grid.cell();
        looked += at.normal * (1.5 * (2 * at.front - 1) * weight * std::max({cell.x, cell.y, cell.z}));
    }
    const Reaching reach = reaching(light, looked);
    glm::dvec3 flat = albedo;
    if (light.volume) {
        const FlatShares shares = flatShares(light);
        flat = albedo * (glm::dot(shares.lights, reach.lights) + shares.everywhere * reach.everywhere + shares.rest +
                         reach.scattered);
    }
    if (!surface) return flat;
    const bool phong = light.surface.model == LightModel::Phong;
    const Reflected even = evenLight(at, albedo, light.surface);
    glm::dvec3 around = double(light.surface.ambient) * (even.diffuse + even.specular);
    if (light.maps) {
        const glm::dvec3 normal = light.maps->fromWorld * at.normal;
        const glm::dvec3 mirrored = light.maps->fromWorld * glm::reflect(-toViewer, at.normal);
        const glm::dvec3 diffuse = glm::mix(light.maps->diffuse.at(-normal), light.maps->diffuse.at(normal), at.front);
        around += even.diffuse * (phong ? double(light.surface.diffuse) : 1.0) * diffuse +
                  (phong ? glm::dvec3(light.surface.specular) : even.specular) * light.maps->specular.at(mirrored);
    }
    glm::dvec3 lit = reach.everywhere * around + albedo * reach.scattered;
    const auto seen = [&](int i) { return i < kShadowLights ? reach.lights[i] : 1.0; };
    lit += reflectedLights<double>(light.lights, light.surface, at, albedo, even, place, seen);
    return glm::mix(flat, lit, weight);
}

} // namespace tessera::vis
