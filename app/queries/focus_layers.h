#pragma once

#include "app/session/session.h"
#include "vis/scene/scene.h"

namespace tessera::app {

/// What is brushed has at least the opacity Selection::focusOpacity in the picture, wherever the transfer function
/// hides it: beside every volume that fades what is not brushed, the scene gets one more, of the brushed samples alone,
/// in the same colours. None where the function itself is as opaque over all values that may be brushed. Without any
/// volume, the first surface or slice that is drawn says the parameter.
void addFocusLayers(vis::Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::app
