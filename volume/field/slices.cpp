#include "volume/field/slices.h"

namespace tessera::volume {

Field slicesOf(const Field& field, SliceRange slices) {
    Field out;
    out.lattice = slicesOf(field.lattice, slices);
    out.type = field.type;
    out.offset = field.offset;
    out.scale = field.scale;
    const std::size_t slice = std::size_t(field.lattice.size.x) * std::size_t(field.lattice.size.y);
    const auto from = std::ptrdiff_t(slice * std::size_t(slices.first)),
               to = from + std::ptrdiff_t(out.lattice.count());
    const auto bytes = std::ptrdiff_t(byteSize(field.type));
    out.samples.assign(field.samples.begin() + from * bytes, field.samples.begin() + to * bytes);
    if (field.mask) out.mask = std::make_shared<const Mask>(field.mask->begin() + from, field.mask->begin() + to);
    return out;
}

} // namespace tessera::volume
