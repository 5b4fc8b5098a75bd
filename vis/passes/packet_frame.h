#pragma once

#include "vis/passes/renderer_state.h"

/// Pictures whose rays the processor casts: the same buffers, tiles and passes as those of OpenGL, which presents them.
namespace tessera::vis {

/// Makes what views share of the source's samples.
void makePacketVolumes(RendererState& shared);

/// Whether the processor casts the rays of a call.
bool chooseEngine(RendererState& shared, ViewTarget& target, const RenderCall& call, FrameStatus& status);

/// Draws a call, or keeps the former picture while its samples are being read; false if they cannot be read.
bool drawByPackets(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start,
                   FrameStatus& status);

/// Draws a call whose program is being compiled, where the processor may and can and its samples are here; false if
/// not.
bool drawWhileCompiling(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start);

/// OpenGL draws what the processor began, in tiles of its own.
void handOverToGl(RendererState& shared, ViewTarget& target);

} // namespace tessera::vis
