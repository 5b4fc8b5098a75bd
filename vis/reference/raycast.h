#pragma once

#include "vis/reference/image.h"
#include "vis/reference/options.h"
#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"

/// The judge of everything the ray caster's shader draws: the formulas of vis/optics/ray_setup.h and
/// volume/reconstruct/reconstruct.h, one sample at a time, on the CPU, without any shortcut (no skipping, no levels, no
/// textures).
namespace tessera::vis::reference {

/// Renders the layers of a scene at full resolution. Lines (box, contours) are not drawn; layers of unknown channels
/// show nothing. Same input, same output on any number of threads. Throws Error when the source does.
Image render(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

/// The same with rays, colours and accumulation in single precision: how much rounding alone may change a picture.
Image renderSingle(const Scene& scene, const volume::BrickSource& source, glm::ivec2 size, const Options& options = {});

} // namespace tessera::vis::reference
