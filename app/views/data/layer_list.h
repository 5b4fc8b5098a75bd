#pragma once

#include "app/pane/view_context.h"

#include <string>

/// The layers that 3D views draw, as a list.
namespace tessera::app {

/// "Volume", "Iso-surface", ...
const char* kindName(const vis::Technique& technique);

/// A row for each layer with an eye that hides it; rows are dragged to change the order.
void drawLayerList(ViewContext& context, const volume::DatasetInfo& info, int& selected);

/// Buttons that add a layer, and copy or remove the selected one.
void drawLayerButtons(ViewContext& context, const volume::DatasetInfo& info, int& selected);

/// Adds a layer of a kind (0 volume, 1 iso-surface, 2 slice, 3 flow) that shows something at once, and selects it in
/// every list of layers.
void addLayer(Session& session, const volume::BrickSource& source, std::size_t kind);

} // namespace tessera::app
