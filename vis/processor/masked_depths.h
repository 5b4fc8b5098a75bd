#pragma once

#include "vis/packet/packet_renderer.h"

namespace tessera::vis {

/// A whole picture with the scene's shadows of depth (vis/formulas/depth_mask.h), by its picks; `frame`: of the data.
/// Twin: depthDifference in vis/shaders/resolve.frag.glsl.
packet::PacketPicture maskedDepths(const packet::PacketPicture& picture, const Scene& scene, const WorldFrame& frame);

} // namespace tessera::vis
