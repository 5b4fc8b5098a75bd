#include "vis/processor/surface_shading.h"

#include "vis/optics/look_sample.h"
#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

/// Light besides lamps at a place and from a direction.
struct LightAround {
    const packet::SceneLight& light;
    glm::dvec4 visible(glm::dvec3 place) const { return glm::dvec4(light.volume->visibleAt(place)); }
    glm::dvec3 scattered(glm::dvec3 place) const { return glm::dvec3(light.volume->scatteredAt(place)); }
    glm::dvec3 diffuse(glm::dvec3 direction) const { return light.maps->diffuse.at(direction); }
    glm::dvec3 specular(glm::dvec3 direction) const { return light.maps->specular.at(direction); }
};

glm::dvec3 unitOrZero(glm::dvec3 v, double least) {
    const double square = glm::dot(v, v);
    return square > least ? v / std::sqrt(square) : glm::dvec3(0);
}

/// Curvature in the direction of the viewer: the change of the normal along the tangent that points there. `dx`, `dy`:
/// of the place from pixel to pixel; `turnX`, `turnY`: of the normal.
double curvatureOf(const LookSample& at, glm::dvec3 dx, glm::dvec3 dy, glm::dvec3 turnX, glm::dvec3 turnY) {
    const glm::dvec3 across = unitOrZero(at.at.toViewer - glm::dot(at.at.normal, at.at.toViewer) * at.at.normal, 1e-12);
    const double xx = glm::dot(dx, dx), yy = glm::dot(dy, dy), xy = glm::dot(dx, dy);
    const double x = glm::dot(across, dx), y = glm::dot(across, dy), area = xx * yy - xy * xy;
    if (!(area > 0)) return 0;
    return std::abs(glm::dot(((x * yy - y * xy) * turnX + (y * xx - x * xy) * turnY) / area, across));
}

} // namespace

SurfaceShading::SurfaceShading(const Scene& scene, const volume::DatasetInfo& info, const packet::SceneLight& light,
                               glm::ivec2 size)
    : scene_(scene), frame_(worldFrame(info, scene.stretch)),
      middle_(cameraRay(scene.camera, double(size.x) / size.y, {0, 0})), around_(light),
      clips_(placeClips(scene.clips, frame_)), lenses_(placeLenses(scene, frame_)),
      look_(lookView(scene, frame_.halfSize, worldCell(info.lattice, frame_), size)) {
    light_.surface = scene.lighting;
    light_.lights = ownLights(scene.lighting, scene.camera);
    light_.maps = light.maps;
    by_ = shadedBy(light_);
    if (light.volume) by_.setVolume(light.volume->grid, !light.volume->scattered.empty());
    for (const DrawnGeometry& drawn : drawnGeometry(scene, lenses_)) {
        const GeometryLayer& layer = scene.geometry[std::size_t(drawn.layer)];
        layers_.push_back({&layer, drawn.lens, colorsOf(scene, info, layer)});
    }
}

double SurfaceShading::along(glm::dvec3 world) const {
    return scene_.camera.projection == Projection::Perspective ? glm::distance(world, middle_.origin)
                                                               : glm::dot(world - middle_.origin, middle_.direction);
}

glm::dvec3 SurfaceShading::toViewer(glm::dvec3 world) const {
    return scene_.camera.projection == Projection::Perspective ? glm::normalize(middle_.origin - world)
                                                               : -middle_.direction;
}

glm::dvec3 SurfaceShading::ownColor(const SurfaceLayer& layer, double value) const {
    if (!layer.colors || std::isnan(value)) return linearFromSrgb(glm::dvec3(layer.layer->style.color));
    const Range range = layer.colors->range;
    const double width = range.hi - range.lo;
    const double place = width == 0 ? 0.5 : std::clamp((value - range.lo) / width, 0.0, 1.0);
    return linearFromSrgb(glm::dvec3(evaluate(*layer.colors->function, {0, 1}, place)));
}

glm::dvec3 SurfaceShading::lit(glm::dvec3 albedo, glm::dvec3 normal, glm::dvec3 world) const {
    return shade<double>(by_, LightAround{around_}, albedo, normal, 1, world, toViewer(world));
}

/// `normals`: of the places of a spot, of length 1.
LookSample SurfaceShading::lookSample(const GeometryLayer& layer, const SurfaceSpot& spot,
                                      const std::array<glm::dvec3, 3>& normals) const {
    const Look& look = layer.style.look;
    const glm::dvec3 world = spot.here.world;
    LookSample at = lookSampleAt<double>(look, look_,
                                         {.world = world,
                                          .toViewer = toViewer(world),
                                          .along = glm::dot(world - middle_.origin, middle_.direction),
                                          .distance = along(world),
                                          .share = 1,
                                          .steepness = 1,
                                          .gradient = normals[0],
                                          .weight = 1,
                                          .cut = layer.style.cutByBox});
    at.curvature = curvatureOf(at, spot.right.world - world, spot.above.world - world, normals[1] - normals[0],
                               normals[2] - normals[0]);
    if (look.charcoal) at.grain = marksAt(*look.charcoal, world, at.at.normal, SurfaceBend(0), at.pixel);
    return at;
}

std::optional<SurfaceColor> SurfaceShading::operator()(const SurfaceLayer& layer, bool line, const SurfaceSpot& spot,
                                                       glm::vec4 tint) const {
    const glm::dvec3 world = spot.here.world;
    const glm::dvec3 flat = glm::cross(spot.right.world - world, spot.above.world - world);
    const auto normalOf = [&](const SurfacePoint& point) {
        if (!line) return glm::dot(point.direction, point.direction) < 1e-20 ? flat : point.direction;
        // Shaded as a tube: the normal points to the viewer in the middle and sideways at the edges.
        const glm::dvec3 tangent = glm::normalize(point.direction);
        const glm::dvec3 beside = unitOrZero(glm::cross(tangent, toViewer(point.world)), 1e-8);
        return glm::cross(beside, tangent) * std::sqrt(std::max(0.0, 1 - point.side * point.side)) +
               beside * point.side;
    };
    if (!kept(clips_, world)) return std::nullopt;
    const LensAction action = lensAction(lenses_, layer.lens, world);
    double opacity = std::min(double(layer.layer->style.opacity) * double(tint.a) * action.opacity, 1.0);
    if (opacity <= 0) return std::nullopt;
    const glm::dvec3 normal = normalOf(spot.here);
    if (layer.layer->style.rim > 0) {
        const bool outwards = glm::dot(spot.here.direction, spot.here.direction) >= 1e-20;
        if (!line && (glm::dot(normal, toViewer(world)) > 0 || !outwards)) return std::nullopt;
        return SurfaceColor{along(world), glm::dvec4(ownColor(layer, spot.here.value) * opacity, opacity)};
    }
    glm::dvec3 color = tint.r >= 0 ? glm::dvec3(glm::vec3(tint)) : ownColor(layer, spot.here.value);
    color = withStrokes(color, spot.here.stroke, double(layer.layer->style.strokes));
    color = glm::mix(glm::dvec3(luminance(color)), color, action.saturation);
    const Look& look = layer.layer->style.look;
    if (look.any()) {
        const LookSample at = lookSample(
            *layer.layer, spot,
            {glm::normalize(normal), glm::normalize(normalOf(spot.right)), glm::normalize(normalOf(spot.above))});
        opacity = lookOpacity(look, opacity, at);
        if (opacity < 0.002) return std::nullopt;
        color = lookColor(look, color, lit(lookAlbedo(look, color, at.share), normal, world), at, look_.ground);
    } else {
        color = lit(color, normal, world);
    }
    return SurfaceColor{along(world), glm::dvec4(color * opacity, opacity)};
}

} // namespace tessera::vis
