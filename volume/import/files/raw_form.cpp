// Reads the form of a raw file: the JSON sidecar and the text of --raw.
#include "volume/base/error.h"
#include "volume/field/axes_json.h"
#include "volume/field/labels.h"
#include "volume/import/files/import_limits.h"
#include "volume/import/files/raw.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace tessera::volume {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kMostRawBytes = 1e15;
constexpr std::size_t kMostComponents = 4096;

std::optional<RawType> parseType(std::string_view word) {
    struct Word {
        std::string_view word;
        RawType type;
    };
    static constexpr Word kWords[] = {
        {"uint8", RawType::U8}, {"u8", RawType::U8},  {"uchar", RawType::U8},   {"u1", RawType::U8},
        {"int8", RawType::I8},  {"i8", RawType::I8},  {"i1", RawType::I8},      {"uint16", RawType::U16},
        {"u16", RawType::U16},  {"u2", RawType::U16}, {"ushort", RawType::U16}, {"int16", RawType::I16},
        {"i16", RawType::I16},  {"i2", RawType::I16}, {"short", RawType::I16},  {"int32", RawType::I32},
        {"i32", RawType::I32},  {"i4", RawType::I32}, {"int", RawType::I32},    {"float32", RawType::F32},
        {"f32", RawType::F32},  {"f4", RawType::F32}, {"float", RawType::F32},  {"float64", RawType::F64},
        {"f64", RawType::F64},  {"f8", RawType::F64}, {"double", RawType::F64}};
    if (!word.empty() && (word[0] == '<' || word[0] == '|')) word.remove_prefix(1);
    for (const Word& known : kWords)
        if (known.word == word) return known.type;
    return std::nullopt;
}

/// "is -1, ", the beginning of a complaint about a value.
std::string isValue(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    if (text.size() > 40) text = text.substr(0, 37) + "...";
    return "is " + text + ", ";
}

std::string isNumber(double value) {
    return std::isfinite(value) ? isValue(value) : "is not finite, ";
}

/// Throws unless the form describes a file that could exist.
void check(const RawForm& form, const std::string& file) {
    for (int axis = 0; axis < 3; ++axis) {
        const int n = form.lattice.size[axis];
        if (n < 1 || n > kMostSamplesPerAxis)
            throw Error("is " + std::to_string(n) + ", must be 1.." + std::to_string(kMostSamplesPerAxis), file,
                        "dims[" + std::to_string(axis) + "]");
        const double step = form.lattice.spacing[axis];
        if (!(step > 0) || !std::isfinite(step))
            throw Error(isNumber(step) + "must be a number above 0", file, "spacing[" + std::to_string(axis) + "]");
        if (!std::isfinite(form.lattice.origin[axis])) throw Error("must be finite", file, "origin");
    }
    if (form.components.empty()) throw Error("holds no component", file, "components");
    for (std::size_t i = 0; i < form.times.size(); ++i)
        if (!std::isfinite(form.times[i]) || (i > 0 && form.times[i] <= form.times[i - 1]))
            throw Error(
                isNumber(form.times[i]) +
                    (i > 0 ? "must be above " + json(form.times[i - 1]).dump() + " before it" : "must be finite"),
                file, "times[" + std::to_string(i) + "]");
    const double bytes = 8.0 * form.lattice.size.x * form.lattice.size.y * form.lattice.size.z *
                         double(form.components.size()) * double(form.frames());
    if (!(bytes <= kMostRawBytes)) throw Error("needs more than 10^15 bytes", file, "dims");
}

/// Typed access to a JSON object that reports the place of a mistake.
struct Reader {
    const json& object;
    const std::string& file;
    std::string path;

    const json* find(const char* key) const {
        const auto at = object.find(key);
        return at == object.end() || at->is_null() ? nullptr : &*at;
    }
    [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
        throw Error(reason, file, path + key);
    }
    /// Fails with the value that was met.
    [[noreturn]] void refuse(const json& value, const std::string& key, const std::string& reason) const {
        fail(key, isValue(value) + reason);
    }
    std::string text(const char* key) const {
        const json* value = find(key);
        if (value == nullptr) return {};
        if (!value->is_string()) refuse(*value, key, "must be a text");
        return value->get<std::string>();
    }
    double number(const char* key, double standard) const {
        const json* value = find(key);
        if (value == nullptr) return standard;
        if (!value->is_number()) refuse(*value, key, "must be a number");
        return value->get<double>();
    }
    RawType type(const char* key) const {
        const std::string word = text(key);
        const std::optional<RawType> known = parseType(word);
        if (!known) fail(key, "unknown type \"" + word.substr(0, 40) + "\"");
        return *known;
    }
    std::vector<double> missing(const char* key) const {
        const json* value = find(key);
        if (value == nullptr || (value->is_string() && (*value == "nan" || *value == "NaN"))) return {};
        if (!value->is_number()) refuse(*value, key, "must be a number, \"nan\" or null");
        return {value->get<double>()};
    }
    glm::dvec3 triple(const char* key, glm::dvec3 standard) const {
        const json* value = find(key);
        if (value == nullptr) return standard;
        if (!value->is_array() || value->size() > 3) refuse(*value, key, "must be three numbers");
        for (std::size_t axis = 0; axis < value->size(); ++axis) {
            if (!(*value)[axis].is_number()) refuse(*value, key, "must be three numbers");
            standard[static_cast<int>(axis)] = (*value)[axis].get<double>();
        }
        return standard;
    }
};

std::vector<Label> readLabels(const json& value, const Reader& reader) {
    std::vector<Label> labels;
    if (!value.is_object() || value.size() > 100'000) reader.fail("labels", "must be an object of value: name");
    for (const auto& [key, name] : value.items()) {
        int number = 0;
        const auto parsed = std::from_chars(key.data(), key.data() + key.size(), number);
        if (parsed.ec != std::errc() || parsed.ptr != key.data() + key.size() || !name.is_string())
            reader.fail("labels", "must be an object of value: name");
        labels.push_back(labelOf(number, name.get<std::string>()));
    }
    std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.value < b.value; });
    return labels;
}

RawForm::Component readComponent(const json& entry, const std::string& file, const std::string& path,
                                 const RawForm::Component& standard) {
    RawForm::Component component = standard;
    if (entry.is_string()) {
        component.name = entry.get<std::string>();
        return component;
    }
    if (!entry.is_object()) throw Error("must be an object", file, path);
    const Reader reader{entry, file, path + "."};
    if (reader.find("name") != nullptr) component.name = reader.text("name");
    component.unit = reader.text("unit");
    if (reader.find("dtype") != nullptr) component.type = reader.type("dtype");
    component.scale = reader.number("scale", 1);
    component.offset = reader.number("offset", 0);
    if (entry.contains("missing_value")) component.missing = reader.missing("missing_value");
    component.presenceOf = reader.text("presence_of");
    if (const json* flag = reader.find("categorical")) {
        if (!flag->is_boolean()) reader.refuse(*flag, "categorical", "must be true or false");
        component.categorical = flag->get<bool>();
    }
    if (const json* labels = reader.find("labels")) component.labels = readLabels(*labels, reader);
    if (component.name.empty()) throw Error("must not be empty", file, path + ".name");
    return component;
}

/// Sets the axes that a sidecar states, and their sheet.
void takeAxes(const Reader& reader, Lattice& lattice) {
    const json *axes = reader.find("axes"), *origin = reader.find("origin");
    if (axes == nullptr) return;
    const bool statesSheet = reader.find("spacing") != nullptr && origin != nullptr && origin->is_array();
    const std::string text = axes->dump(-1, ' ', false, json::error_handler_t::replace);
    lattice = withStatedAxes(lattice, statesSheet, text, reader.file, "axes");
}

Quantity readQuantity(const json& entry, std::size_t frames, const std::string& file, const std::string& path) {
    if (!entry.is_object()) throw Error("must be an object", file, path);
    const Reader reader{entry, file, path + "."};
    Quantity quantity{reader.text("name"), reader.text("unit"), {}};
    if (quantity.name.empty()) reader.fail("name", "must not be empty");
    const json* values = reader.find("values");
    if (values == nullptr || !values->is_array() || values->size() != frames)
        reader.fail("values", "must be a list of a number, or null, for each time");
    for (const json& value : *values) {
        if (!value.is_number() && !value.is_null()) reader.refuse(value, "values", "must be numbers or null");
        quantity.values.push_back(value.is_null() ? std::nan("") : value.get<double>());
    }
    return quantity;
}

} // namespace

RawForm parseSidecar(std::string_view text, const std::string& file) {
    const json document = json::parse(text, nullptr, false);
    if (document.is_discarded()) throw Error("is not JSON", file);
    const std::string what = otherThanSidecar(text);
    if (!what.empty()) throw Error("is no sidecar of a raw file, which has dims, but " + what, file);
    const Reader reader{document, file, ""};
    RawForm form;

    const json* const dims = &document["dims"];
    if (!dims->is_array() || dims->empty() || dims->size() > 3)
        reader.refuse(*dims, "dims", "must be one to three whole numbers");
    for (std::size_t axis = 0; axis < dims->size(); ++axis) {
        const json& n = (*dims)[axis];
        const std::string place = "dims[" + std::to_string(axis) + "]";
        if (!n.is_number_integer()) reader.refuse(n, place, "must be a whole number");
        const double value = n.get<double>();
        if (!(value >= 1 && value <= kMostSamplesPerAxis))
            reader.refuse(n, place, "must be 1.." + std::to_string(kMostSamplesPerAxis));
        form.lattice.size[static_cast<int>(axis)] = static_cast<int>(value);
    }
    RawForm::Component standard;
    standard.name = "value";
    standard.type = reader.type("dtype");
    standard.missing = reader.missing("missing_value");
    form.lattice.spacing = reader.triple("spacing", glm::dvec3(1));
    // "origin" is a position if it is three numbers, else a text on the source of the data.
    if (const json* origin = reader.find("origin")) {
        if (origin->is_string())
            form.provenance = origin->get<std::string>();
        else
            form.lattice.origin = reader.triple("origin", glm::dvec3(0));
    }
    takeAxes(reader, form.lattice);
    if (reader.find("provenance") != nullptr) form.provenance = reader.text("provenance");
    form.lengthUnit = reader.text("length_unit");
    form.timeName = reader.text("time_name");
    form.timeUnit = reader.text("time_unit");
    form.dataFile = reader.text("file");
    if (form.dataFile.find('\0') != std::string::npos) reader.fail("file", "is not a file name");
    if (const std::string order = reader.text("byte_order"); order == "big")
        form.bigEndian = true;
    else if (!order.empty() && order != "little")
        reader.fail("byte_order", "must be \"little\" or \"big\"");

    if (const json* components = reader.find("components")) {
        if (components->is_array()) {
            if (components->size() > kMostComponents) reader.fail("components", "are too many");
            for (std::size_t i = 0; i < components->size(); ++i)
                form.components.push_back(
                    readComponent((*components)[i], file, "components[" + std::to_string(i) + "]", standard));
        } else {
            reader.fail("components", "must be a list");
        }
    } else {
        form.components.push_back(standard);
    }
    for (std::size_t i = 0; i < form.components.size(); ++i)
        for (std::size_t other = 0; other < i; ++other)
            if (form.components[i].name == form.components[other].name)
                throw Error("\"" + form.components[i].name + "\" is present twice", file,
                            "components[" + std::to_string(i) + "]");
    if (const json* times = reader.find("times")) {
        if (!times->is_array() || times->empty() || times->size() > kMostTimes) reader.fail("times", "must be a list");
        for (const json& time : *times) {
            if (!time.is_number()) reader.refuse(time, "times", "must be numbers");
            form.times.push_back(time.get<double>());
        }
    }
    if (const json* quantities = reader.find("quantities")) {
        if (!quantities->is_array() || quantities->size() > kMostComponents)
            reader.fail("quantities", "must be a list");
        for (std::size_t q = 0; q < quantities->size(); ++q)
            form.quantities.push_back(
                readQuantity((*quantities)[q], form.frames(), file, "quantities[" + std::to_string(q) + "]"));
    }
    check(form, file);
    return form;
}

namespace {

const std::string kRawPlace = "--raw";

template <class T> T parseNumber(std::string_view text, std::string_view key) {
    T value{};
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size())
        throw Error("\"" + std::string(text) + "\" is not a number", {}, kRawPlace + " " + std::string(key));
    return value;
}

/// "AxBxC" (or A:B:C): three numbers.
template <class T> glm::vec<3, T> parseTriple(std::string_view text, std::string_view key) {
    glm::vec<3, T> values{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? text.find_first_of("x:") : text.size();
        if (end == std::string_view::npos)
            throw Error("needs three numbers like 64x64x32", {}, kRawPlace + " " + std::string(key));
        values[axis] = parseNumber<T>(text.substr(0, end), key);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return values;
}

} // namespace

RawForm parseRawOption(std::string_view text) {
    RawForm form;
    form.lattice.size = glm::ivec3(0);
    std::optional<RawType> type;
    std::size_t components = 1, times = 1;
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find(','));
        text.remove_prefix(std::min(item.size() + 1, text.size()));
        const std::size_t equals = item.find('=');
        const std::string_view key = item.substr(0, equals);
        const std::string_view value = equals == std::string_view::npos ? "" : item.substr(equals + 1);
        if (key == "dims") {
            form.lattice.size = parseTriple<int>(value, key);
        } else if (key == "type" || key == "dtype") {
            type = parseType(value);
            if (!type) throw Error("unknown type \"" + std::string(value) + "\"", {}, kRawPlace);
        } else if (key == "spacing") {
            form.lattice.spacing = parseTriple<double>(value, key);
        } else if (key == "origin") {
            form.lattice.origin = parseTriple<double>(value, key);
        } else if (key == "components") {
            components = parseNumber<std::size_t>(value, key);
        } else if (key == "times") {
            times = parseNumber<std::size_t>(value, key);
        } else if (key == "skip") {
            form.skip = parseNumber<std::size_t>(value, key);
        } else if (key == "big-endian" || key == "little-endian") {
            form.bigEndian = key == "big-endian";
        } else {
            throw Error("unknown word \"" + std::string(key) + "\"", {}, kRawPlace);
        }
    }
    if (form.lattice.size == glm::ivec3(0)) throw Error("needs dims=XxYxZ", {}, kRawPlace);
    if (!type) throw Error("needs type=u8, i16, u16, i32, f32 or f64", {}, kRawPlace);
    const auto inRange = [](std::size_t value, std::size_t least, std::size_t most, const char* word) {
        if (value < least || value > most)
            throw Error("is " + std::to_string(value) + ", must be " + std::to_string(least) + ".." +
                            std::to_string(most),
                        {}, kRawPlace + " " + word);
    };
    inRange(components, 1, kMostComponents, "components");
    inRange(times, 1, kMostTimes, "times");
    inRange(form.skip, 0, std::size_t(kMostRawBytes), "skip");
    for (std::size_t i = 0; i < components; ++i) {
        RawForm::Component component;
        component.name = components == 1 ? "value" : "value" + std::to_string(i);
        component.type = *type;
        form.components.push_back(component);
    }
    if (times > 1) {
        form.timeName = "step";
        for (std::size_t i = 0; i < times; ++i) form.times.push_back(double(i));
    }
    check(form, {});
    return form;
}

std::string rawOptionOfName(const std::string& path) {
    const fs::path file(path);
    std::string name = file.stem().string();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    // Words between separators, each with one meaning; the last one with a meaning is used.
    std::string dims, type, components, times;
    const auto countAfter = [](std::string_view word, char letter) {
        return word.size() > 1 && word.size() < 6 && word[0] == letter &&
               word.find_first_not_of("0123456789", 1) == std::string_view::npos;
    };
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t end = std::min(name.find_first_of("_-. ()[],", at), name.size());
        const std::string word = name.substr(at, end - at);
        at = end + 1;
        if (parseType(word))
            type = word;
        else if (countAfter(word, 'c'))
            components = ",components=" + word.substr(1);
        else if (countAfter(word, 't'))
            times = ",times=" + word.substr(1);
        else if (std::count(word.begin(), word.end(), 'x') == 2 &&
                 word.find_first_not_of("0123456789x") == std::string::npos)
            dims = word;
    }
    if (dims.empty() || type.empty()) return {};
    std::error_code failed;
    const auto bytes = fs::file_size(file, failed);
    if (failed) return {};
    const std::string stated = "dims=" + dims + ",type=" + type;
    for (const std::string& option : {stated + components + times, stated}) try {
            if (parseRawOption(option).bytes() == bytes) return option;
        } catch (const Error&) { // other numbers in the name
        }
    return {};
}

} // namespace tessera::volume
