#pragma once

#include "vis/passes/ray_pass.h"

/// Draws a view within the budget of a call: reduced, at half resolution, then tile by tile.
namespace tessera::vis {

/// Reports once which lights, clips and lenses exceed a limit, and what exceeds one of the engine's own.
void sayLimits(RendererState& shared, const RenderCall& call, const std::string& ofEngine);

/// Draws the changed pixels at reduced resolution with longer steps, and presents them.
void drawReduced(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                 Pace::Reduction how);

/// Draws a reduced picture if the whole does not fit the budget; at rest then the whole at half resolution, and tiles
/// at full resolution. `lit`: its light is final.
void drawWithin(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                Clock::time_point start, bool lit);

} // namespace tessera::vis
