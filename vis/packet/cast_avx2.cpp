#include "vis/packet/cast.h"
#include "vis/packet/cast_medium.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castAvx2(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    avx2::castTile(job, begin, end);
}
void mediumAvx2(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out) {
    avx2::fillRow(job, grid, row, out);
}

} // namespace tessera::vis::packet
