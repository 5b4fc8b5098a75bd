#include "vis/packet/cast.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castAvx2(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    avx2::castTile(job, begin, end);
}

} // namespace tessera::vis::packet
