#pragma once

#include "vis/packet/cast_job.h"

/// One ray caster for each instruction set, compiled from the same source. A function may only be called where the
/// processor has the instructions.
namespace tessera::vis::packet {

/// Casts the rays of the pixels [begin, end).
void castAvx512(const CastJob& job, glm::ivec2 begin, glm::ivec2 end); ///< not on other processors than x86
void castAvx2(const CastJob& job, glm::ivec2 begin, glm::ivec2 end);   ///< the same
void castPlain(const CastJob& job, glm::ivec2 begin, glm::ivec2 end);

} // namespace tessera::vis::packet
