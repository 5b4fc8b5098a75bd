#pragma once

#include "tests/reference/image.h"
#include "tests/reference/options.h"
#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"

/// Reference renderer that the ray-casting shader is tested against: the formulas of vis/optics/ray_setup.h and
/// volume/reconstruct/reconstruct.h, one sample at a time on the CPU in double precision, without shortcuts (no
/// empty-space skipping, no levels of detail, no textures).
namespace tessera::vis::reference {

/// Renders the layers of a scene at full resolution. The box is not drawn; layers of unknown channels are left out. The
/// result does not depend on the number of threads. Throws Error when the source does.
Image render(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

/// The same with rays, colours and accumulation in single precision: shows how much rounding may change a picture.
Image renderSingle(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

} // namespace tessera::vis::reference
