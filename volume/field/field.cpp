#include "volume/field/field.h"

#include "volume/base/parallel.h"
#include "volume/system/free_memory.h"

namespace tessera::volume {

double Field::value(std::size_t index) const {
    return dispatch(type, [&]<class T>(T) { return offset + scale * static_cast<double>(as<T>()[index]); });
}

Field makeField(const Lattice& lattice, ScalarType type) {
    Field field;
    field.lattice = lattice;
    field.type = type;
    const std::size_t bytes = lattice.count() * byteSize(type);
    reserveLarge(field.samples, bytes);
    field.samples.resize(bytes);
    return field;
}

std::vector<double> physicalValues(const Field& field) {
    std::vector<double> values(field.count());
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        parallelFor(
            values.size(), [&](std::size_t i) { values[i] = field.offset + field.scale * double(stored[i]); }, 1 << 16);
    });
    return values;
}

} // namespace tessera::volume
