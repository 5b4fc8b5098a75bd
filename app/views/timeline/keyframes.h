#pragma once

#include "app/pane/tool_row.h"

#include <functional>
#include <string>

/// Keyframes by hand: their rows in the timeline, and the menu that every parameter has.
namespace tessera::app {

/// Tools that set keys for the camera and the time, and the place in the animation.
void drawKeyframeButtons(ViewContext& context, ToolRow& tools);

/// A ruler to drag the position along and a row per parameter with its keys: drag a key to move it, right-click it for
/// its easing. Fills the width and `height` pixels, with a scroll bar where that is too little.
void drawKeyframes(ViewContext& context, float height);
/// Pixels that all rows need.
float keyframesHeight(const Session& session);

/// The menu on a parameter's label, by its path: keys, and variants of a side-by-side view.
std::function<void(const std::string&)> parameterMenu(ViewContext& context);

} // namespace tessera::app
