#pragma once

#include "app/pane/view_context.h"
#include "app/tools/camera_controller.h"

namespace tessera::app {

/// The menu of a volume view, if its popup `id` is open: camera, focus, what is placed where it was opened, and what
/// the view shows. `target`: what was drawn there last, for picking; may be null.
void drawVolumeMenu(ViewContext& context, const char* id, VolumeView& view, vis::ViewTarget* target,
                    const PictureBox& picture, const vis::WorldFrame& world);

} // namespace tessera::app
