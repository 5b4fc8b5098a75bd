#include "vis/processor/present_lanes.h"

namespace tessera::vis {

void presentRowAvx2(const PresentedWith& with, const PixelRow& row) {
    packet::avx2::presentPixels(with, row);
}

} // namespace tessera::vis
