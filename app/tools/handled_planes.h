#pragma once

#include "app/tools/space_handles.h"

/// Planes with handles: those of oblique views, of slice layers with a place or a tilt of their own, and clip planes. A
/// dot in the middle moves the plane along its normal, the tip of an arrow tilts it. The bodies that clip have a dot in
/// the middle that moves them and dots at the ends of their radii, half edges or half length; an arrow tilts a
/// cylinder.
namespace tessera::app {

inline constexpr double kTiltArrow = 0.1; ///< length of an arrow, in distances of the camera from its target

void addPlanes(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);
void addClipBodies(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);

/// The direction, in the world, of an arrow from `middle` to `tip`, both physical; length 1.
glm::dvec3 arrowWay(const vis::WorldFrame& world, glm::dvec3 middle, glm::dvec3 tip);

} // namespace tessera::app
