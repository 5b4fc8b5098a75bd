#pragma once

#include "app/session/session.h"

namespace tessera::app {

/// Adds a layer on top of the others and selects it in every list of layers; nothing where there are as many as are
/// drawn (app/session/session_json.h).
void addLayer(Session& session, vis::Layer layer);

} // namespace tessera::app
