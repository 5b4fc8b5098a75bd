#pragma once

#include "app/session/session.h"
#include "volume/bricks/brick_source.h"

#include <string>

namespace tessera::app {

/// Adds a layer of a kind (0 volume, 1 iso-surface, 2 slice, 3 flow) that shows something at once, and selects it in
/// every list of layers.
void addLayer(Session& session, const volume::BrickSource& source, std::size_t kind);

/// A layer's name that is made of its parameter ("O2", "O2 slice", "Volume of O2") follows when another is chosen.
void followChannel(std::string& name, const std::string& before, const std::string& now);

} // namespace tessera::app
