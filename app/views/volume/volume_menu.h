#pragma once

#include "app/pane/view_context.h"
#include "app/tools/camera_controller.h"
#include "vis/scene/camera.h"

/// The menu of a picture of the scene.
namespace tessera::app {

/// Draws the popup of that name where it is open; `target`: the picture last drawn, null if there is none.
void drawVolumeMenu(ViewContext& context, const char* id, VolumeView& view, vis::ViewTarget* target,
                    const PictureBox& picture, const vis::WorldFrame& world);

} // namespace tessera::app
