#pragma once

#include "app/pane/axes3d.h"
#include "app/session/session.h"

#include <imgui.h>

namespace tessera::app {

/// In the picture of data that a plane in space and time is cut from: where it lies at the first and at the last time
/// at which it meets them, each with its time. The outline at the time shown is one of the handles (space_handles.h).
/// Nothing where the plane does not move, or is all of space at one time.
void drawPlaneInSpace(ImDrawList& draw, const SpaceFrame& space, const Session& session,
                      const volume::DatasetInfo& info);

} // namespace tessera::app
