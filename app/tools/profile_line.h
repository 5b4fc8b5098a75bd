#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/view_context.h"

/// Lines of line-profile views, drawn in 3D views and slices.
namespace tessera::app {

/// Corners of a profile's line: its own, or the longest axis through the cursor.
std::vector<glm::dvec3> profileCorners(const ProfileView& view, const Session& session, const volume::Box& bounds);

/// Every profile's line that has corners of its own, with a dot at each.
void drawProfileLines(ImDrawList& draw, const SpaceFrame& frame, const Session& session);
/// The same seen across a plane.
void drawProfileLines(ImDrawList& draw, const PlaneFrame& frame, const Session& session);

} // namespace tessera::app
