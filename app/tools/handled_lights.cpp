#include "app/tools/handled_lights.h"

#include "vis/optics/surface_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace tessera::app {

namespace {

constexpr double kBall = 0.72;                       ///< radius, in half heights of the picture at the target
constexpr double kArrowEnd = 0.72, kArrowHead = 0.8; ///< where arrows end and their heads begin, in radii
constexpr double kHeadWidth = 0.03;
constexpr double kStar = 0.05;   ///< arms of a point light, in radii
constexpr double kFarthest = 10; ///< of a point light, the range of its position

/// The colour of a light, darker on a light window and lighter on a dark one: white light is to be seen on white.
ImU32 handleColor(glm::vec3 color) {
    const glm::vec3 seen = darkTheme() ? 0.7f * color + 0.3f : 0.5f * color;
    return toColor({seen.r, seen.g, seen.b});
}

void addArrow(HandledObject& object, const vis::WorldFrame& world, glm::dvec3 target, glm::dvec3 toLight,
              double radius) {
    const auto at = [&](double along, glm::dvec3 aside) {
        return world.toPhysical(target + (toLight * along + aside) * radius);
    };
    const glm::dvec3 other = std::abs(toLight.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(toLight, other)), v = glm::cross(toLight, u);
    object.lines.emplace_back(at(1, {}), at(kArrowEnd, {}));
    for (const glm::dvec3& side : {u, -u, v, -v})
        object.lines.emplace_back(at(kArrowEnd, {}), at(kArrowHead, side * kHeadWidth));
}

} // namespace

void aimLight(vis::Light& light, glm::dvec3 from, const vis::Camera& camera) {
    const double length = glm::length(from);
    if (!(length > 0)) return;
    glm::dvec3 own = from / length;
    if (light.kind == vis::LightKind::Viewer) own = glm::normalize(glm::dquat(camera.orientation)) * own;
    light.azimuth = static_cast<float>(glm::degrees(std::atan2(own.x, own.z)));
    light.elevation = static_cast<float>(glm::degrees(std::asin(std::clamp(own.y, -1.0, 1.0))));
}

void addFocus(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info) {
    if (!(session.camera.aperture > 0)) return;
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    HandledObject object;
    object.key = object.name = "focus";
    object.task = SceneTask::Picture;
    object.color = plotColors().text;
    object.handles = {{.at = world.toPhysical(glm::dvec3(session.camera.focus)), .whole = true}};
    object.outlined = true;
    object.move = [world](Session& edited, std::size_t, glm::dvec3 to) {
        edited.camera.focus = glm::vec3(world.toWorld(to));
    };
    objects.push_back(std::move(object));
}

void addLights(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info) {
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const vis::Camera& camera = session.camera;
    const glm::dvec3 target(camera.target);
    const double half = std::tan(glm::radians(static_cast<double>(camera.fieldOfView)) / 2);
    const double radius = kBall * static_cast<double>(camera.distance) * half;
    for (std::size_t i = 0; i < session.lighting.lights.size(); ++i) {
        const vis::Light& light = session.lighting.lights[i];
        if (!light.enabled) continue;
        HandledObject object;
        object.key = "light " + std::to_string(i);
        object.task = SceneTask::Light;
        object.entry = static_cast<int>(i);
        object.name = "light " + std::to_string(i + 1);
        object.color = handleColor(light.color);
        object.outlined = true;
        if (light.kind == vis::LightKind::Point) {
            const glm::dvec3 at(light.position);
            object.handles = {{.at = world.toPhysical(at), .whole = true, .how = HandleWay::Beyond}};
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 arm(0);
                arm[axis] = kStar * radius;
                object.lines.emplace_back(world.toPhysical(at - arm), world.toPhysical(at + arm));
            }
            object.move = [i, world](Session& edited, std::size_t, glm::dvec3 to) {
                edited.lighting.lights[i].position = glm::vec3(glm::clamp(world.toWorld(to), -kFarthest, kFarthest));
            };
        } else {
            const glm::dvec3 toLight = vis::lightDirection(light, camera);
            object.handles = {{.at = world.toPhysical(target + toLight * radius),
                               .whole = true,
                               .how = HandleWay::Around,
                               .way = world.toPhysical(target)}};
            addArrow(object, world, target, toLight, radius);
            object.move = [i, world, target](Session& edited, std::size_t, glm::dvec3 to) {
                aimLight(edited.lighting.lights[i], world.toWorld(to) - target, edited.camera);
            };
        }
        objects.push_back(std::move(object));
    }
}

} // namespace tessera::app
