#include "vis/optics/look_shading.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

LookView lookView(const Scene& scene, glm::dvec3 halfSize, glm::dvec3 cell, glm::ivec2 size) {
    const double aspect = double(size.x) / std::max(size.y, 1);
    const Ray middle = cameraRay(scene.camera, aspect, {0, 0}), up = cameraRay(scene.camera, aspect, {0, 1});
    LookView view;
    const std::vector<PlacedLight> lights = placeLights(scene.lighting, scene.camera, 1);
    if (!lights.empty())
        view.light = lights.front();
    else
        view.light.place = lightDirection(Light{}, scene.camera);
    const double center = -glm::dot(middle.origin, middle.direction),
                 extent = glm::dot(glm::abs(middle.direction), halfSize);
    view.nearest = center - extent;
    view.farthest = center + extent;
    if (scene.camera.projection == Projection::Perspective) view.nearest = std::max(view.nearest, 0.0);
    view.farthest = std::max(view.farthest, view.nearest + 1e-6);
    const glm::dvec3 slope = up.direction / glm::dot(up.direction, middle.direction) - middle.direction;
    view.pixel =
        glm::dvec2(glm::length(up.origin - middle.origin), glm::length(slope)) * 2.0 / double(std::max(size.y, 1));
    view.reach = std::min({cell.x, cell.y, cell.z});
    view.ground = linearFromSrgb(glm::dvec3(groundColor(scene)));
    view.halfSize = halfSize;
    return view;
}

const glm::dvec3& linearInk(bool dark) {
    static const glm::dvec3 light = linearFromSrgb(glm::dvec3(kLightInk)), black = linearFromSrgb(glm::dvec3(kDarkInk));
    return dark ? black : light;
}

bool drawsLight(const CharcoalDrawing& charcoal, glm::dvec3 ground) {
    return charcoal.color ? charcoal.stick == Stick::Chalk : luminance(ground) < 0.075;
}

double grainSoftness(const CharcoalDrawing& charcoal) {
    return glm::mix(0.5, 0.05, double(charcoal.hardness));
}

double bendReach(const Look& look, const LookView& view) {
    return view.reach * std::max(1.0, 1.5 * double(look.smooth));
}

} // namespace tessera::vis
