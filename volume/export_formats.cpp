#include "volume/export_formats.h"

#include <limits>
#include <nlohmann/json.hpp>

namespace tessera::volume {

std::string exactText(double value) {
    return nlohmann::json(value).dump();
}

namespace {

/// Absent floats become NaN; integers stay as they are.
void markAbsent(Field& field) {
    if (!field.mask || field.type != ScalarType::F32) return;
    const auto values = field.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!field.present(i)) values[i] = std::numeric_limits<float>::quiet_NaN();
}

} // namespace

Field asFloat(const Field& field) {
    Field out = makeField(field.lattice, ScalarType::F32);
    const auto values = out.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(field.value(i));
    out.mask = field.mask;
    markAbsent(out);
    return out;
}

Storage storageOf(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    const Parameter& what = dataset.info.parameters[std::size_t(parameter)];
    Storage storage{what.type, false, 1, 0};
    if (what.type == ScalarType::F32) return storage;
    for (std::size_t t = 0; t < times.size(); ++t) {
        const Field field = dataset.load(parameter, 0, times[t]);
        storage.presence = storage.presence || field.mask;
        if (t == 0) {
            storage.scale = field.scale;
            storage.offset = field.offset;
        } else if (field.scale != storage.scale || field.offset != storage.offset) {
            return {};
        }
    }
    return storage;
}

bool isStoredAs(const Field& field, const Storage& storage) {
    return field.type == storage.type && (field.type != ScalarType::F32 || (field.scale == 1 && field.offset == 0));
}

Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage) {
    Field field = dataset.load(parameter, component, time);
    if (!isStoredAs(field, storage)) field = asFloat(field);
    markAbsent(field);
    return field;
}

std::vector<std::uint8_t> presenceOf(const Field& field) {
    return field.mask ? *field.mask : Mask(field.count(), 1);
}

void writeField(AtomicFile& file, const Field& field) {
    file.write(field.samples.data(), field.samples.size());
}

} // namespace tessera::volume
