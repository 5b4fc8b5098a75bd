#include "volume/export/export_formats.h"

#include "volume/base/printable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace tessera::volume {

namespace {

/// Absent floats become NaN; integers stay as they are.
void markAbsent(Field& field) {
    if (!field.mask || field.type != ScalarType::F32) return;
    std::size_t i = 0;
    for (float& value : field.as<float>())
        if (!field.present(i++)) value = std::numeric_limits<float>::quiet_NaN();
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
            const Field field = dataset.read(parameter, c, time);
            storage.presence = storage.presence || field.mask;
            if (time == times.front()) storage.scaling[std::size_t(c)] = {field.scale, field.offset};
            if (!isStoredAs(field, c, storage)) return floatStorage(what.components);
        }
    return storage;
}

bool masksAgree(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    for (const int time : times) {
        const Field first = dataset.read(parameter, 0, time);
        for (int c = 1; c < dataset.info.parameters[std::size_t(parameter)].components; ++c) {
            const Field other = dataset.read(parameter, c, time);
            if (first.mask != other.mask && presenceOf(first) != presenceOf(other)) return false;
        }
    }
    return true;
}

bool isStoredAs(const Field& field, int component, const Storage& storage) {
    return field.type == storage.type && Scaling{field.scale, field.offset} == storage.scaling[std::size_t(component)];
}

Field loadAs(const Dataset& dataset, int parameter, int component, int time, const Storage& storage) {
    Field field = dataset.read(parameter, component, time);
    if (!isStoredAs(field, component, storage)) field = asFloat(field);
    markAbsent(field);
    return field;
}

namespace {

/// `own` if it can represent integers from lo to hi, else the smallest type that can, else floats.
ScalarType typeFor(ScalarType own, Range range) {
    for (const ScalarType type : {own, ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32}) {
        const bool holds = dispatch(type, [range]<class T>(T) {
            return range.lo >= double(std::numeric_limits<T>::lowest()) &&
                   range.hi <= double(std::numeric_limits<T>::max());
        });
        if (holds) return type;
    }
    return ScalarType::F32;
}

/// The type for the values of an integer parameter; none if the stored numbers are the values.
std::optional<ScalarType> typeOfValues(const Dataset& dataset, int parameter, const std::vector<int>& times) {
    const Parameter& what = dataset.info.parameters[std::size_t(parameter)];
    if (what.type == ScalarType::F32 || what.categorical) return std::nullopt;
    bool scaled = false, whole = true;
    Range range{0, 0}; // absent samples become 0
    for (const int time : times)
        for (int c = 0; c < what.components; ++c) {
            const Field field = dataset.read(parameter, c, time);
            scaled = scaled || Scaling{field.scale, field.offset} != Scaling{};
            whole = whole && field.scale == std::rint(field.scale) && field.offset == std::rint(field.offset);
            for (std::size_t i = 0; i < field.count(); ++i) {
                if (!field.present(i)) continue;
                range.lo = std::min(range.lo, field.value(i));
                range.hi = std::max(range.hi, field.value(i));
            }
        }
    if (!scaled) return std::nullopt;
    return whole ? typeFor(what.type, range) : ScalarType::F32;
}

/// Physical values, which are whole numbers that `type` holds; absent samples 0.
Field asWhole(const Field& field, ScalarType type) {
    Field out = makeField(field.lattice, type);
    out.mask = field.mask;
    dispatch(type, [&]<class T>(T) {
        const auto values = out.as<T>();
        for (std::size_t i = 0; i < values.size(); ++i)
            if (field.present(i)) values[i] = static_cast<T>(field.value(i));
    });
    return out;
}

} // namespace

Dataset withValues(Dataset dataset, const std::vector<int>& parameters, const std::vector<int>& times) {
    std::map<int, ScalarType> types;
    for (const int p : parameters)
        if (const auto type = typeOfValues(dataset, p, times)) types[p] = *type;
    for (const auto& [p, type] : types) dataset.info.parameters[std::size_t(p)].type = type;
    dataset.read = [read = std::move(dataset.read), types](int parameter, int component, int time) {
        Field field = read(parameter, component, time);
        const auto type = types.find(parameter);
        if (type == types.end()) return field;
        return type->second == ScalarType::F32 ? asFloat(field) : asWhole(field, type->second);
    };
    return dataset;
}

std::vector<std::uint8_t> presenceOf(const Field& field) {
    return field.mask ? *field.mask : Mask(field.count(), 1);
}

void writeField(AtomicFile& file, const Field& field) {
    file.write(field.samples.data(), field.samples.size());
}

std::string xmlText(const std::string& text) {
    std::string out;
    for (const char c : printable(text)) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

} // namespace tessera::volume
