#include "vis/optics/shade.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// What an Illumination knows of a place and of directions.
struct LightAt {
    const Illumination& light;
    glm::dvec4 visible(glm::dvec3 place) const { return light.volume->visibleAt(place); }
    glm::dvec3 scattered(glm::dvec3 place) const { return light.volume->scatteredAt(place); }
    glm::dvec3 diffuse(glm::dvec3 direction) const { return light.maps->diffuse.at(direction); }
    glm::dvec3 specular(glm::dvec3 direction) const { return light.maps->specular.at(direction); }
};

} // namespace

Illumination illuminate(const Lighting& lighting, const Camera& camera, const CubeMap* picture) {
    Illumination light;
    light.surface = lighting;
    light.lights = ownLights(lighting, camera);
    if (usesMaps(lighting))
        light.maps = std::make_shared<const LightMaps>(lightMaps(lighting, camera, environmentMaps(lighting, picture)));
    return light;
}

FlatShares flatShares(const Lighting& surface, std::span<const PlacedLight> lights) {
    FlatShares shares;
    const double ambient = surface.ambient, others = surface.model == LightModel::Phong ? double(surface.diffuse) : 1;
    shares.everywhere = ambient + others > 0 ? ambient / (ambient + others) : 0;
    double sum = 0;
    for (const PlacedLight& each : lights) sum += luminance(each.color);
    double hidden = 0;
    for (std::size_t i = 0; i < lights.size() && i < std::size_t(kShadowLights) && sum > 0; ++i) {
        shares.lights[int(i)] = (1 - shares.everywhere) * luminance(lights[i].color) / sum;
        hidden += shares.lights[int(i)];
    }
    shares.rest = 1 - shares.everywhere - hidden;
    return shares;
}

ShadedBy shadedBy(const Illumination& light) {
    ShadedBy by;
    by.surface = &light.surface;
    by.lights = light.lights;
    by.maps = light.maps != nullptr;
    if (light.maps) by.fromWorld = light.maps->fromWorld;
    if (light.volume) by.setVolume(light.volume->grid, !light.volume->scattered.empty());
    return by;
}

void ShadedBy::setVolume(const LightGrid& grid, bool withScattered) {
    volume = true;
    scatters = withScattered;
    shares = flatShares(*surface, lights);
    const glm::dvec3 edges = grid.cell();
    cell = std::max({edges.x, edges.y, edges.z});
}

glm::dvec3 shade(const Illumination& light, glm::dvec3 albedo, glm::dvec3 gradient, double weight, glm::dvec3 place,
                 glm::dvec3 toViewer) {
    return shade<double>(shadedBy(light), LightAt{light}, albedo, gradient, weight, place, toViewer);
}

} // namespace tessera::vis
