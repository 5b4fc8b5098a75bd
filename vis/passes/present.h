#pragma once

#include "vis/passes/renderer_state.h"

/// Shows what was drawn: from buffers of rays, or of the processor, to the picture of a view.
namespace tessera::vis {

/// Shows a tile of a picture, whose rays lie in `from`, over the ground, with the box.
void present(RendererState& shared, ViewTarget& target, const Scene& scene, const RayBuffer& from, const Tile& tile);

/// Presents a tile of the first pass from what the processor has drawn of it: software GL takes several times as long.
void presentPackets(RendererState& shared, ViewTarget& target, const Scene& scene, const Tile& tile);

/// Whether the programs that present the scene, whole and enlarged, are ready; starts their compilation otherwise.
bool presentable(RendererState& shared, const ViewTarget& target, const Scene& scene);

/// Shows the background, and the box once that can be drawn, until the first picture is ready.
void showBlank(RendererState& shared, ViewTarget& target, const Scene& scene);

/// Shows only the background: nothing is loaded, or the program does not compile.
void showNothing(RendererState& shared, ViewTarget& target, const Scene& scene);

/// Keeps the former picture while a program variant is being compiled.
void postpone(RendererState& shared, ViewTarget& target, const Scene& scene);

} // namespace tessera::vis
