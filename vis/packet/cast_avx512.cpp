#include "vis/packet/cast.h"
#include "vis/packet/cast_medium.h"
#include "vis/packet/cast_single.h"

namespace tessera::vis::packet {

void castAvx512(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    avx512::castTile(job, begin, end);
}
void mediumAvx512(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out) {
    avx512::fillRow(job, grid, row, out);
}

} // namespace tessera::vis::packet
