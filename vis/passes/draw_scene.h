#pragma once

#include "vis/passes/renderer_state.h"

/// Draws a scene: asks for its data, draws what is resident, and asks again where that shows more.
namespace tessera::vis {

/// Resizes the target to the picture; returns false, with a single message, if the driver has no memory.
bool resizeTarget(RendererState& shared, ViewTarget& target, const FrameRequest& request);

/// Uploads loaded data within the scene's limits.
void beginFrame(RendererState& shared, ViewTarget& target, const Scene& scene, const FrameRequest& request);

/// Draws the scene as far as the request allows.
void drawAll(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start,
             FrameStatus& status);

} // namespace tessera::vis
