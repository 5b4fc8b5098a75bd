#include "vis/packet/cast.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castAvx512(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    avx512::castTile(job, begin, end);
}

} // namespace tessera::vis::packet
