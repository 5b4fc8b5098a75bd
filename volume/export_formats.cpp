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

Storage floatStorage(int components) {
    return {ScalarType::F32, false, std::vector<Scaling>(std::size_t(components))};
}

Storage storageOf(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    const Parameter& what = dataset.info.parameters[std::size_t(parameter)];
    Storage storage = floatStorage(what.components);
    if (what.type == ScalarType::F32) return storage;
    storage.type = what.type;
    for (const int time : times)
        for (int c = 0; c < what.components; ++c) {
            const Field field = dataset.load(parameter, c, time);
            storage.presence = storage.presence || field.mask;
            if (time == times.front()) storage.scaling[std::size_t(c)] = {field.scale, field.offset};
            if (!isStoredAs(field, c, storage)) return floatStorage(what.components);
        }
    return storage;
}

bool masksAgree(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    for (const int time : times) {
        const Field first = dataset.load(parameter, 0, time);
        for (int c = 1; c < dataset.info.parameters[std::size_t(parameter)].components; ++c) {
            const Field other = dataset.load(parameter, c, time);
            if (first.mask != other.mask && presenceOf(first) != presenceOf(other)) return false;
        }
    }
    return true;
}

bool isStoredAs(const Field& field, int component, const Storage& storage) {
    return field.type == storage.type && Scaling{field.scale, field.offset} == storage.scaling[std::size_t(component)];
}

Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage) {
    Field field = dataset.load(parameter, component, time);
    if (!isStoredAs(field, component, storage)) field = asFloat(field);
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
