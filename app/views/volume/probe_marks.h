#pragma once

#include "app/pane/axes3d.h"
#include "app/session/session.h"

#include <vector>

namespace tessera::app {

/// A dot with its name at each probe that the data hold.
void drawProbes(ImDrawList& draw, const SpaceFrame& space, const std::vector<Probe>& probes,
                const volume::DatasetInfo& info);

} // namespace tessera::app
