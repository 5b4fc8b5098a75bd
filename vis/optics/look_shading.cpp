#include "vis/optics/look_shading.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

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

glm::dvec3 inkOn(double luminance) {
    return glm::mix(linearFromSrgb(glm::dvec3(kLightInk)), linearFromSrgb(glm::dvec3(kDarkInk)),
                    glm::smoothstep(0.03, 0.12, luminance));
}

bool drawsLight(const CharcoalDrawing& charcoal, glm::dvec3 ground) {
    return charcoal.color ? charcoal.stick == Stick::Chalk : luminance(ground) < 0.075;
}

double lookShare(LookPart part, double interest) {
    return part == LookPart::Everything ? 1 : part == LookPart::Context ? 1 - interest : interest;
}

double solidOpacity(const Look& look, double opacity, double share) {
    return look.charcoal ? glm::mix(opacity, glm::smoothstep(0.03, 0.4, opacity), share) : opacity;
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

double bendReach(const Look& look, const LookView& view) {
    return view.reach * std::max(1.0, 1.5 * double(look.smooth));
}

glm::dvec4 marksAt(const CharcoalDrawing& charcoal, glm::dvec3 place, glm::dvec3 normal, SurfaceBend bend,
                   double pixel) {
    const double size = pixel * double(charcoal.grain) / kGrainTexels;
    const GrainTile& tile = *grainTile();
    const glm::dvec2 grain = grainAt(tile, place, normal, size);
    if (charcoal.mark == Mark::Dots) return {grain.x, 0.5, 0.5, grain.y};
    const glm::dvec3 along =
        strokeDirection(normal, bend, double(charcoal.follow), glm::radians(double(charcoal.angle)));
    const double crossing =
        charcoal.crossing < 1 ? strokesAt(tile, place, normal, glm::cross(normal, along), size, kCrossingShift) : 0.5;
    return {grain.x, strokesAt(tile, place, normal, along, size, 0), crossing, grain.y};
}

double charcoalInk(const CharcoalDrawing& charcoal, glm::dvec3 lit, const LookSample& sample, bool light) {
    const double bright = std::sqrt(std::clamp(luminance(lit), 0.0, 1.0)), bare = double(charcoal.bare);
    const double drawn =
        std::pow(std::max((light ? bright : 1 - bright) - bare, 0.0) / (1 - bare), double(charcoal.contrast));
    const double steep = glm::mix(1.0, std::sqrt(std::clamp(sample.steepness, 0.0, 1.0)), double(charcoal.steepness));
    const double tone = drawn * (light ? drawn : 2 - drawn) * steep;
    const double open = glm::mix(1.0, glm::smoothstep(0.1, 0.6, 1 - bright), double(charcoal.closure));
    const double width = double(charcoal.outline) * sample.pixel;
    const double thin = 1 - 0.8 * glm::smoothstep(0.12, 0.45, width * sample.curvature);
    const double line = double(charcoal.outlineStrength) * sample.weight * open * thin *
                        outline(sample.facing(), sample.curvature, width);
    const double pressure = double(charcoal.pressure), drawnTone = pressure * tone, drawnLine = pressure * line;
    const double both = 1 - (1 - drawnTone) * (1 - drawnLine), soft = grainSoftness(charcoal);
    const auto mark = [&](double amount, double threshold) {
        return glm::smoothstep(threshold - soft, threshold + soft, amount * (1 + 2 * soft) - soft);
    };
    const auto layer = [&](double amount, double stroke) {
        if (!(amount > 0)) return 0.0;
        const double a = 0.5 * double(charcoal.tooth), covered = std::pow(amount, 1 - a), edge = 0.06 + 0.18 * a;
        const double stroked = std::pow(amount, a) * glm::smoothstep(1 - covered - edge, 1 - covered + edge, stroke);
        return mark(glm::mix(amount, stroked, double(charcoal.strokes)), sample.grain.x);
    };
    double ink = mark(both, sample.grain.w);
    if (charcoal.mark == Mark::Strokes) {
        const double first = std::min(drawnTone, glm::mix(double(charcoal.crossing), drawnTone, 0.4));
        const double second = 1 - (1 - drawnTone) / std::max(1 - first, 1e-3);
        const double tooth = glm::mix(0.5, sample.grain.x, double(charcoal.tooth));
        ink = 1 - (1 - layer(first, sample.grain.y)) * (1 - layer(second, sample.grain.z)) *
                      (1 - (drawnLine > 0 ? mark(drawnLine, tooth) : 0));
    }
    return glm::mix(ink, both, double(charcoal.smudge));
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
        const glm::dvec3 toned = glm::mix(linear(own->coolColor), linear(own->warmColor), 0.5 + 0.5 * light) *
                                 glm::mix(glm::dvec3(1), albedo, std::min(double(own->ownColor), 1.0));
        color = glm::mix(color, toned, double(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.cartoon) {
        const double width = double(own->outline) * sample.pixel;
        const double amount = double(own->amount) * sample.weight * sample.share;
        const glm::dvec3 inner = own->outlineColor ? linear(*own->outlineColor) : inkOn(luminance(albedo));
        const glm::dvec3 outer = own->outlineColor ? inner : inkOn(luminance(background));
        color = glm::mix(color, inner, amount * outline(sample.facing(), sample.curvature, width));
        color = glm::mix(color, outer, amount * outline(sample.facing(), sample.curvature, 0.5 * width));
    }
    if (const auto& own = look.silhouette) {
        const glm::dvec3 ink = own->inkColor ? linear(*own->inkColor) : inkOn(luminance(background));
        const double turned = std::pow(1 - std::min(sample.facing(), 1.0), double(own->exponent));
        color = glm::mix(color, ink, double(own->ink) * turned * sample.weight * sample.share);
    }
    if (const auto& own = look.charcoal) {
        const glm::dvec3 stick = own->color ? linear(*own->color) : inkOn(luminance(background));
        const double ink = charcoalInk(*own, lit, sample, drawsLight(*own, background));
        color = glm::mix(color, glm::mix(background, stick, ink), sample.share);
    }
    if (const auto& own = look.wire)
        color = glm::mix(color, glm::mix(linear(own->color), color, double(own->ownColor)), sample.wire * sample.share);
    if (const auto& own = look.distance)
        color = glm::mix(color, own->toBackground ? background : linear(own->color),
                         double(own->amount) * std::pow(std::clamp(sample.depth, 0.0, 1.0), double(own->exponent)) *
                             sample.share);
    return color;
}

} // namespace tessera::vis
