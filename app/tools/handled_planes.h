#pragma once

#include "app/tools/space_handles.h"

/// Planes with handles: those of oblique views, of slice layers with a place or a tilt of their own, and clip planes. A
/// dot in the middle moves the plane along its normal, the tip of an arrow tilts it.
namespace tessera::app {

void addPlanes(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info);

} // namespace tessera::app
