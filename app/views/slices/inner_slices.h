#pragma once

#include "app/session/session.h"
#include "vis/scene/scene.h"

/// What lenses show in slices.
namespace tessera::app {

/// Lenses with layers of their own show these layers' parameters in their section, as `like` is drawn; others nothing.
void addInnerSlices(vis::Scene& scene, const Session& session, const vis::SliceLayer& like);

} // namespace tessera::app
