#pragma once

#include "app/pane/view_context.h"
#include "app/tools/camera_controller.h"
#include "vis/passes/stereo_picture.h"
#include "vis/scene/stereo.h"

#include <array>

/// Pictures of the scene for one eye or both.
namespace tessera::app {

/// What is kept from frame to frame.
struct EyePictures {
    std::array<vis::ViewTargetPtr, 2> targets; ///< the second of the right eye, if there are two
    vis::StereoPicture anaglyph;
};

struct RenderedEyes {
    vis::FrameStatus status;                    ///< of both together
    std::array<vis::TextureName, 2> textures{}; ///< the picture, or side by side that of each eye
};

/// Renders the scene as `stereo` says; the time of the request is shared by both eyes. Side by side each picture is
/// half as wide as that of the request. Tells context.answers how far they are.
RenderedEyes renderEyes(ViewContext& context, EyePictures& pictures, vis::Scene scene, vis::FrameRequest request,
                        const vis::Stereo& stereo);

/// Where the picture of one eye stands.
PictureBox halfPicture(const PictureBox& whole, const vis::Stereo& stereo, vis::Eye eye);

} // namespace tessera::app
