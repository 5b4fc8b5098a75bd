#include "vis/processor/present_lanes.h"

namespace tessera::vis {

void presentRowAvx512(const PresentedWith& with, const PixelRow& row) {
    packet::avx512::presentPixels(with, row);
}

} // namespace tessera::vis
