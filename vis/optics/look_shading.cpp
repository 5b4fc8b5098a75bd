#include "vis/optics/look_shading.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
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
    return view;
}

double lookShare(LookPart part, double interest) {
    return part == LookPart::Everything ? 1 : part == LookPart::Context ? 1 - interest : interest;
}

double lookOpacity(const Look& look, double opacity, const LookSample& sample) {
    double factor = 1;
    if (const auto& own = look.boundary)
        factor *= double(own->retained) +
                  double(own->strength) * std::pow(std::clamp(sample.steepness, 0.0, 1.0), double(own->exponent));
    if (const auto& own = look.silhouette)
        factor *= double(own->retained) + double(own->strength) * sample.weight *
                                              std::pow(1 - std::min(sample.facing(), 1.0), double(own->exponent));
    if (const auto& own = look.wire) factor *= glm::mix(double(own->retained), 1.0, sample.wire);
    return std::min(1.0, opacity * glm::mix(1.0, factor, sample.share));
}

glm::dvec3 lookAlbedo(const Look& look, glm::dvec3 albedo, double share) {
    if (!look.charcoal) return albedo;
    return glm::mix(albedo, glm::mix(glm::dvec3(1), albedo, double(look.charcoal->localTone)), share);
}

double wireCoverage(glm::dvec3 world, glm::dvec3 normal, glm::dvec3 toViewer, double spacing, double width,
                    double pixel) {
    double along = glm::dot(normal, toViewer), covered = 0;
    along = along < 0 ? std::min(along, -0.02) : std::max(along, 0.02);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 change = -toViewer[axis] / along * normal;
        change[axis] += 1;
        const double gap = spacing / std::max(glm::length(change) * pixel, 1e-6);
        const double x = world[axis] / spacing, away = std::abs(x - std::floor(x + 0.5)) * gap;
        const double line = glm::mix(std::clamp(0.5 * width + 0.5 - away, 0.0, 1.0), std::min(width / gap, 1.0),
                                     std::clamp(2 - 0.5 * gap, 0.0, 1.0));
        const double slope = std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis]));
        covered = std::max(covered, line * glm::smoothstep(0.1, 0.35, slope));
    }
    return covered;
}

double outline(double facing, double curvature, double thickness) {
    const double bent = std::min(1.0, thickness * curvature);
    const double limit = std::sqrt(bent * (2 - bent));
    return 1 - glm::smoothstep(0.5, 1.0, facing / std::max(limit, 1e-6));
}

double lightStep(double light, int steps) {
    return std::min(steps - 1.0, std::floor(steps * std::max(0.0, light))) / (steps - 1.0);
}

double grainSoftness(const CharcoalDrawing& charcoal) {
    return glm::mix(0.5, 0.05, double(charcoal.hardness));
}

double charcoalInk(const CharcoalDrawing& charcoal, glm::dvec3 lit, const LookSample& sample) {
    const double bright = std::sqrt(std::clamp(luminance(lit), 0.0, 1.0));
    const double drawn = charcoal.stick == Stick::Chalk ? bright : 1 - bright;
    const double steep = glm::mix(1.0, std::sqrt(std::clamp(sample.steepness, 0.0, 1.0)), double(charcoal.steepness));
    const double tone = std::pow(drawn, double(charcoal.contrast)) * steep;
    const double open = glm::mix(1.0, glm::smoothstep(0.1, 0.6, 1 - bright), double(charcoal.closure));
    const double line = double(charcoal.outlineStrength) * sample.weight * open *
                        outline(sample.facing(), sample.curvature, double(charcoal.outline) * sample.pixel);
    const double density = double(charcoal.pressure) * (1 - (1 - tone) * (1 - line));
    const double stroked = std::min(1.0, density * (1 + double(charcoal.strokes) * (2 * sample.grain.y - 1)));
    const double soft = grainSoftness(charcoal);
    const double ink = glm::smoothstep(sample.grain.x - soft, sample.grain.x + soft, stroked * (1 + 2 * soft) - soft);
    return glm::mix(ink, density, double(charcoal.smudge));
}

glm::dvec3 lookColor(const Look& look, glm::dvec3 albedo, glm::dvec3 lit, const LookSample& sample,
                     glm::dvec3 background) {
    const auto linear = [](glm::vec3 srgb) { return linearFromSrgb(glm::dvec3(srgb)); };
    glm::dvec3 color = lit;
    double light = sample.light();
    if (const auto& own = look.cartoon) {
        light = lightStep(light, own->steps);
        color = glm::mix(color, albedo * glm::mix(double(own->shadow), 1.0, light),
                         double(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.tone) {
        const glm::dvec3 toned = glm::mix(linear(own->coolColor), linear(own->warmColor), 0.5 + 0.5 * light) +
                                 double(own->ownColor) * std::max(light, 0.0) * albedo;
        color = glm::mix(color, toned, double(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.cartoon) {
        const double line = outline(sample.facing(), sample.curvature, double(own->outline) * sample.pixel);
        color = glm::mix(color, linear(own->outlineColor), line * double(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.charcoal)
        color = glm::mix(color, glm::mix(background, linear(own->color), charcoalInk(*own, lit, sample)), sample.share);
    if (const auto& own = look.wire)
        color = glm::mix(color, glm::mix(linear(own->color), color, double(own->ownColor)), sample.wire * sample.share);
    if (const auto& own = look.distance)
        color = glm::mix(color, own->toBackground ? background : linear(own->color),
                         double(own->amount) * std::pow(std::clamp(sample.depth, 0.0, 1.0), double(own->exponent)) *
                             sample.share);
    return color;
}

} // namespace tessera::vis
