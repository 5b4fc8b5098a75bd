#include "vis/processor/present_lanes.h"

namespace tessera::vis {

void presentRowPlain(const PresentedWith& with, const PixelRow& row) {
    packet::plain::presentPixels(with, row);
}

} // namespace tessera::vis
