#pragma once

#include "app/tools/space_handles.h"

/// Planes with handles: those of oblique views, of slice layers with a place or a tilt of their own, and clip planes. A
/// dot in the middle moves the plane along its normal, the tip of an arrow tilts it.
namespace tessera::app {

void addPlanes(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);

/// The plane as it crosses a slice through `cursor` across the axis `normal`: the line of both in the box, and the
/// arrow.
std::vector<SpaceLine> planeCrossing(const HandledObject& object, const volume::Box& box, int normal,
                                     glm::dvec3 cursor);

} // namespace tessera::app
