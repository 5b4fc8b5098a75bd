#pragma once

#include "app/data/sources.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"
#include "vis/passes/renderer.h"

#include <string>

/// The line at the lower edge of the window.
namespace tessera::app {

/// What is shown: "channel   128 × 64 × 64 CC   6 parameters, 11 times"; "No data".
std::string dataText(const Sources& sources);
/// Texture memory used, and bricks loaded and waiting: "   textures 12.5 of 512 MiB, 96 bricks, 4 to come"; "" if
/// nothing is loaded.
std::string residencyText(const vis::ResidencyInfo& use);
/// What casts rays.
std::string engineText(const vis::EngineUse& use);

/// Draws a text at the left, or the newest message in its place while it is new, and the jobs at the right, each with a
/// button that cancels it. Messages stand here since over the views they would cover axes and legends; the mouse on one
/// shows all new ones whole, a click takes it away. `height` in pixels, `scale` in pixels per design pixel; `icons`:
/// the font of icons is there; no `jobs`, no `messages`: none are shown.
void drawStatusBar(const std::string& text, Jobs* jobs, Messages* messages, float height, float scale, bool icons);

} // namespace tessera::app
