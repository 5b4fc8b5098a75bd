#include "vis/packet/cast.h"
#include "vis/packet/cast_medium.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castPlain(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    plain::castTile(job, begin, end);
}
void mediumPlain(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out) {
    plain::fillRow(job, grid, row, out);
}

} // namespace tessera::vis::packet
