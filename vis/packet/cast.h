#pragma once

#include "vis/packet/cast_job.h"

/// One ray caster, and what it needs for light, for each instruction set, compiled from the same source. A function may
/// only be called where the processor has the instructions.
namespace tessera::vis::packet {

/// Casts the rays of the pixels [begin, end).
void castAvx512(const CastJob& job, glm::ivec2 begin, glm::ivec2 end); ///< not on other processors than x86
void castAvx2(const CastJob& job, glm::ivec2 begin, glm::ivec2 end);   ///< the same
void castPlain(const CastJob& job, glm::ivec2 begin, glm::ivec2 end);

/// The extinction of a row of cells of a light grid, y + z * size.y (vis/optics/light_volume.h).
void mediumAvx512(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out);
void mediumAvx2(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out);
void mediumPlain(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out);

} // namespace tessera::vis::packet
