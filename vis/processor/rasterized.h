#pragma once

#include "vis/packet/packet_renderer.h"

namespace tessera::vis {

/// The meshes and lines of a scene, as rays meet them: for each pixel the nearest surfaces, as the depth peeling of
/// OpenGL finds them (vis/view/geometry_pass.h). `jitter`: offset of the pixel centres, in pixels.
packet::PacketGeometry rasterized(const Scene& scene, const volume::DatasetInfo& info, const packet::SceneLight& light,
                                  glm::ivec2 size, glm::dvec2 jitter);

} // namespace tessera::vis
