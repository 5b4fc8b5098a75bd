#pragma once

#include "vis/scene/look.h"

namespace tessera::vis {

/// The features of a look, as bits of LookFeature (vis/gl/shader_constants.h).
int lookBits(const Look& look);

} // namespace tessera::vis
