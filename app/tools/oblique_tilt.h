#pragma once

#include "app/session/session.h"
#include "volume/field/dataset.h"

/// Directions that oblique views are tilted to by one click.
namespace tessera::app {

/// The normal (physical) of planes that face the viewer of the volume view clicked last.
glm::dvec3 facingNormal(const Session& session, const volume::DatasetInfo& info);

/// Entries of a menu: across an axis as in the slices view, facing the viewer, seen from the other side.
void drawTiltMenu(const Session& session, const volume::DatasetInfo& info, ObliqueView& view);

/// Tilts every oblique view to face the viewer; false if there is none.
bool faceObliqueSlices(Session& session, const volume::DatasetInfo& info);

} // namespace tessera::app
