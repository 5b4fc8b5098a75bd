#include "app/callouts/callout_place.h"

#include "app/pane/oblique_plane.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tessera::app {

namespace {

constexpr double kMargin = 1.04; ///< around a placeholder in its picture

/// Half the box around a lens.
glm::dvec3 halfOfLens(const vis::PlacedLens& lens) {
    glm::dvec3 half(0);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double part = lens.fromUnit[k][i];
            half[i] += lens.shape == vis::LensShape::Sphere ? part * part : std::abs(part);
        }
    return lens.shape == vis::LensShape::Sphere ? glm::sqrt(half) : half;
}

/// A lens that shows only what is inside of a shape.
vis::Lens cuttingLens(vis::Lens like) {
    like.name = "callout";
    like.effect = vis::LensEffect::Only;
    like.enabled = true;
    like.inverted = like.marks = false;
    like.rim = 0;
    like.strength = 1;
    like.fromTime = like.untilTime = {};
    return like;
}

bool isBall(glm::dvec3 half) {
    return half.x > 0 && glm::length(half - glm::dvec3(half.x)) < 1e-6 * half.x;
}

std::optional<CalloutPlace> lensPlace(const Session& session, const vis::WorldFrame& world, const std::string& name) {
    const auto placed = vis::placeLenses(session.lenses, world, session.camera, session.cursor);
    const int found = vis::findLens(placed, name);
    const auto own =
        std::ranges::find_if(session.lenses, [&](const vis::Lens& lens) { return lens.enabled && lens.name == name; });
    if (found < 0 || own == session.lenses.end()) return std::nullopt;
    const vis::PlacedLens& lens = placed[std::size_t(found)];
    CalloutPlace place{.name = name, .color = own->color, .center = lens.center};
    if (lens.shape == vis::LensShape::Selection) {
        place.center = glm::dvec3(0);
        place.half = world.halfSize;
        place.shape = cuttingLens(*own);
        return place;
    }
    place.region = vis::LensRegion{name};
    if (lens.shape == vis::LensShape::Disc) {
        place.half = glm::dvec3(double(own->size.x));
        place.ball = true;
        return place;
    }
    place.half = halfOfLens(lens);
    place.ball = lens.shape == vis::LensShape::Sphere && isBall(place.half);
    const bool upright = lens.shape == vis::LensShape::Box && own->rotation == glm::vec3(0);
    if (!place.ball && !upright) place.shape = cuttingLens(*own);
    return place;
}

std::optional<CalloutPlace> brushPlace(const Session& session, const vis::WorldFrame& world, const std::string& name) {
    const auto own =
        std::ranges::find_if(session.selection.brushes, [&](const vis::Brush& brush) { return brush.name == name; });
    if (own == session.selection.brushes.end()) return std::nullopt;
    CalloutPlace place{.name = name, .color = own->color};
    place.region = own->region;
    const auto around = [&](const vis::SheetBox& box) {
        place.center = world.sheetToWorld(box.center);
        place.half = glm::abs(box.radius * world.scale);
    };
    if (const auto* lens = std::get_if<vis::LensRegion>(&own->region)) {
        auto inside = lensPlace(session, world, lens->lens);
        if (inside) inside->name = name, inside->color = own->color;
        return inside;
    }
    if (const auto* ball = std::get_if<vis::SphereRegion>(&own->region)) {
        around(vis::sheetBox(*ball, world.axes));
        place.ball = isBall(place.half);
        if (place.ball) return place;
        vis::Lens shape;
        shape.center = world.toPhysical(place.center);
        shape.size = glm::vec3(place.half);
        place.shape = cuttingLens(shape);
    } else if (const auto* box = std::get_if<vis::BoxRegion>(&own->region)) {
        around(vis::sheetBox(*box, world.axes));
    } else {
        place.half = world.halfSize;
        place.alone = *own;
        place.alone->enabled = true;
        place.alone->combine = vis::BrushCombine::And;
    }
    return place;
}

std::optional<CalloutPlace> planePlace(const Session& session, const volume::DatasetInfo& info,
                                       const vis::WorldFrame& world, const std::string& name) {
    CalloutPlace place{.name = name};
    glm::dvec3 normal(0);
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
        place.axis = static_cast<volume::SpaceAxis>(name[0] - 'x');
        normal[name[0] - 'x'] = 1;
    } else {
        const auto found = session.views.find(name);
        const auto* view = found == session.views.end() ? nullptr : std::get_if<ObliqueView>(&found->second);
        if (!view) return std::nullopt;
        normal = unitNormal(view->normal);
        place.name = paneTitle(session, name);
    }
    place.normal = normal;
    const auto corners = planeSection({normal, world.axes.toSheet(session.cursor)}, info.bounds);
    if (corners.empty()) return std::nullopt;
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : corners) middle += world.sheetToWorld(corner) / double(corners.size());
    place.center = middle;
    place.half = world.halfSize;
    return place;
}

} // namespace

double CalloutPlace::radius() const {
    return ball ? half.x : glm::length(half);
}

std::optional<CalloutPlace> calloutPlace(const Session& session, const volume::DatasetInfo& info,
                                         const Callout& callout) {
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    switch (callout.of) {
    case CalloutOf::Lens:
        return lensPlace(session, world, callout.placeholder);
    case CalloutOf::Brush:
        return brushPlace(session, world, callout.placeholder);
    case CalloutOf::Plane:
        return planePlace(session, info, world, callout.placeholder);
    }
    return std::nullopt;
}

vis::Camera calloutCamera(const vis::Camera& view, const Callout& callout, const CalloutPlace& place, double aspect) {
    vis::Camera camera = view;
    camera.orientation = glm::normalize(callout.turn * view.orientation);
    camera.target = place.normal ? glm::vec3(0) : glm::vec3(place.center);
    camera.aperture = 0;
    const double radius = kMargin * std::max(place.radius(), 1e-4);
    const double upwards = std::tan(glm::radians(double(view.fieldOfView)) / 2) * std::min(1.0, aspect);
    const double distance =
        view.projection == vis::Projection::Perspective ? radius / std::sin(std::atan(upwards)) : radius / upwards;
    camera.distance = float(std::clamp(distance / double(callout.zoom), 0.01, 100.0));
    return camera;
}

vis::Scene calloutScene(vis::Scene scene, const Callout& callout, const CalloutPlace& place,
                        const vis::WorldFrame& world, double aspect) {
    scene.camera = calloutCamera(scene.camera, callout, place, aspect);
    scene.showBox = false;
    if (place.alone) {
        scene.selection.brushes = {*place.alone};
        scene.selection.contextOpacity = 0;
        return scene;
    }
    vis::Clip clip{.center = glm::vec3(world.shareOf(place.center))};
    if (place.normal) {
        const glm::dvec3 across = worldNormal(*place.normal, world), look = vis::forwardOf(scene.camera);
        clip.axis = glm::vec3(glm::dot(across, look) > 0 ? -across : across);
    } else if (place.ball) {
        clip.kind = vis::ClipKind::Sphere;
        clip.radius = float(place.half.x);
    } else {
        clip.kind = vis::ClipKind::Box;
        clip.size = glm::vec3(2.0 * place.half);
    }
    scene.clips.insert(scene.clips.begin(), clip);
    const auto acting = std::ranges::count_if(scene.lenses, &vis::Lens::enabled);
    if (place.shape && acting < vis::kMaxLenses) scene.lenses.push_back(*place.shape);
    return scene;
}

void ShownCallout::swap() {
    if (callout_.layers) std::swap(session_.layers, *callout_.layers);
    if (callout_.time) std::swap(session_.time, *callout_.time);
}

} // namespace tessera::app
