#pragma once

#include "app/callouts/callout_part.h"

/// What stands in the box of a callout: a scene, a slice, a plot or a table.
namespace tessera::app {

/// What it shows and where, to say as much as has room in `width` pixels: "T [K], z = 3.1 mm, 0.65 V".
std::string calloutTitle(const ViewContext& context, const Callout& callout, const CalloutPlace& place, float width);

/// Takes the mouse over its content: a drag turns a scene, with Ctrl the view too, and the wheel magnifies it; in a
/// slice a drag moves the cross-hair and the wheel a plane. True while something moves.
bool useCallout(ViewContext& context, const CalloutPart& shown);

/// Draws its content. `view`: the scene of the view, which callouts without layers and time of their own show.
void drawCallout(ViewContext& context, const CalloutPart& shown, const vis::Scene& view, bool moving);

} // namespace tessera::app
