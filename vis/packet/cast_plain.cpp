#include "vis/packet/cast.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castPlain(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    plain::castTile(job, begin, end);
}

} // namespace tessera::vis::packet
