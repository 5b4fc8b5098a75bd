#include "volume/field/frame_reader.h"

namespace tessera::volume {

Field FrameReader::cut(Field whole, SliceRange slices) {
    if (slices.isAllOf(whole.lattice)) return whole;
    return slicesOf(whole, slices);
}

} // namespace tessera::volume
