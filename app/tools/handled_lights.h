#pragma once

#include "app/tools/space_handles.h"

/// Lights with handles: a distant light is a dot on a ball around the centre of rotation, with an arrow the way its
/// light goes, a point light a dot where it is. And the point in focus.
namespace tessera::app {

void addLights(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);

/// The point in focus of a camera with an aperture.
void addFocus(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);

/// Turns a distant light so that it comes from a direction of the world; angles in degrees.
void aimLight(vis::Light& light, glm::dvec3 from, const vis::Camera& camera);

} // namespace tessera::app
