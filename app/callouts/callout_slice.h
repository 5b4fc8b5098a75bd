#pragma once

#include "app/callouts/callout_part.h"

/// Slices in callouts: the plane that a callout shows, flat, or a slice through the middle of its body.
namespace tessera::app {

struct CalloutSlice {
    PlanePicture picture;
    PlaneFrame frame;
};

/// The slice in a box, as large as fits; nothing where there is no parameter to show or no room.
std::optional<CalloutSlice> calloutSlice(ViewContext& context, const Callout& callout, const CalloutPlace& place,
                                         const PictureBox& box);

} // namespace tessera::app
