#include "app/described/describe_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tessera::app::detail {

namespace {

std::string brief(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

void wrongType(const Json& json, std::string_view wanted, std::vector<JsonIssue>& issues, const std::string& path) {
    issues.push_back({path, "needs " + std::string(wanted) + ", found " + json.type_name(), false, {}});
}

void reportUnknown(const Json& json, const std::vector<std::string_view>& known, std::vector<JsonIssue>& issues,
                   const std::string& path) {
    for (const auto& [key, value] : json.items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            issues.push_back({joinPointer(path, key), "unknown key", true, value});
}

std::optional<double> numberFromJson(const Json& json, const FieldInfo& info, bool integer,
                                     std::vector<JsonIssue>& issues, const std::string& path) {
    double value = 0;
    if (json.is_number()) {
        value = json.get<double>();
    } else if (json == "nan" && !integer) {
        value = std::numeric_limits<double>::quiet_NaN();
    } else if (json == "inf" && !integer) {
        value = std::numeric_limits<double>::infinity();
    } else if (json == "-inf" && !integer) {
        value = -std::numeric_limits<double>::infinity();
    } else {
        wrongType(json, "a number", issues, path);
        return {};
    }
    if (integer && (value != std::floor(value) || std::abs(value) > 2147483647.0)) {
        issues.push_back({path, brief(value) + " is not a whole number in the range of 32 bits", false, {}});
        return {};
    }
    if (info.range && !(value >= info.range->lo && value <= info.range->hi)) {
        issues.push_back(
            {path, brief(value) + " is not in " + brief(info.range->lo) + " .. " + brief(info.range->hi), false, {}});
        return {};
    }
    return value;
}

std::string joined(std::span<const std::string_view> names) {
    std::string all;
    for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
    return all;
}

std::optional<std::size_t> nameFromJson(const Json& json, std::span<const std::string_view> names,
                                        std::vector<JsonIssue>& issues, const std::string& path) {
    if (!json.is_string()) {
        wrongType(json, "a name", issues, path);
        return {};
    }
    const auto& word = json.get_ref<const std::string&>();
    const auto found = std::find(names.begin(), names.end(), word);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    issues.push_back({path, "unknown name \"" + word + "\"; known are " + joined(names), false, {}});
    return {};
}

Json numbersToJson(Value value) {
    const auto number = [&](int i) {
        const double own = value.number(i);
        return value.type->whole    ? numberToJson(static_cast<int>(own))
               : value.type->single ? numberToJson(static_cast<float>(own))
                                    : numberToJson(own);
    };
    if (value.kind() == ValueKind::Number) return number(0);
    Json out = Json::array();
    for (int i = 0; i < value.type->numbers; ++i) out.push_back(number(i));
    return out;
}

void membersToJson(Value value, Json& out) {
    value.visitMembers(
        [&](Value member, const FieldInfo& info) { out[std::string(info.key)] = valueToJson(member, info); });
}

/// What is expected of members, with the places of the issues found.
struct Reading {
    const FieldInfo& info;
    std::vector<JsonIssue>& issues;
    const std::string& path;
};

void membersFromJson(Value value, const Json& json, std::vector<std::string_view> known, const Reading& reading) {
    value.visitMembers([&](Value member, const FieldInfo& info) {
        known.push_back(info.key);
        const auto found = json.find(info.key);
        if (found != json.end())
            valueFromJson(member, *found, info, reading.issues, joinPointer(reading.path, info.key));
    });
    reportUnknown(json, known, reading.issues, reading.path);
}

void presetFromJson(Value value, const Json& json, std::vector<JsonIssue>& issues, const std::string& path) {
    const auto names = value.type->presets;
    if (const auto index = nameFromJson(json, names, issues, path)) value.type->setPreset(value.at, names[*index]);
}

void structFromJson(Value value, const Json& json, const Reading& reading) {
    if (!json.is_object()) return wrongType(json, "an object", reading.issues, reading.path);
    std::vector<std::string_view> known;
    if (!value.type->presets.empty()) {
        if (const auto name = json.find("preset"); name != json.end()) {
            presetFromJson(value, *name, reading.issues, joinPointer(reading.path, "preset"));
            known.emplace_back("preset");
        }
    }
    membersFromJson(value, json, std::move(known), reading);
}

void variantFromJson(Value value, const Json& json, const Reading& reading) {
    const auto type = json.is_object() ? json.find("type") : json.end();
    if (!json.is_object() || type == json.end() || !type->is_string()) {
        reading.issues.push_back({reading.path, "needs an object with a \"type\"", false, {}});
        return;
    }
    const auto& wanted = type->get_ref<const std::string&>();
    const auto names = value.type->names;
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found == names.end()) {
        reading.issues.push_back({joinPointer(reading.path, "type"),
                                  "unknown type \"" + wanted + "\"; known are " + joined(names),
                                  false,
                                  {}});
        return;
    }
    value.type->hold(value.at, static_cast<std::size_t>(found - names.begin()));
    membersFromJson(value.inside(), json, {"type"}, reading);
}

void numberFromJson(Value value, const Json& json, const Reading& reading) {
    const auto number = numberFromJson(json, reading.info, value.type->whole, reading.issues, reading.path);
    if (!number) return;
    if (value.type->single && std::abs(*number) > double(std::numeric_limits<float>::max()) && !std::isinf(*number)) {
        reading.issues.push_back({reading.path, "too large", false, {}});
        return;
    }
    value.setNumber(*number);
}

/// Reads a range, vector or quaternion: an array of its numbers, all of them or none.
void numbersFromJson(Value value, const Json& json, const Reading& reading) {
    const auto count = static_cast<std::size_t>(value.type->numbers);
    if (!json.is_array() || json.size() != count)
        return wrongType(json, "an array of " + std::to_string(count) + " numbers", reading.issues, reading.path);
    std::array<double, 4> parts{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto part =
            numberFromJson(json[i], reading.info, false, reading.issues, joinPointer(reading.path, std::to_string(i)));
        if (!part) return;
        parts[i] = *part;
    }
    for (std::size_t i = 0; i < count; ++i) value.setNumber(parts[i], static_cast<int>(i));
}

/// Of layers, lenses, keyframes and the like; lists of plain numbers may be longer, and a series may have many files.
constexpr std::size_t kMostElements = 10'000, kMostFiles = 1'000'000;

void listFromJson(Value value, const Json& json, const Reading& reading) {
    if (!json.is_array()) return wrongType(json, "an array", reading.issues, reading.path);
    value.type->resize(value.at, 0); // elements start from their defaults
    const std::size_t most = reading.path.ends_with("/files") ? kMostFiles : kMostElements;
    if (json.size() > most && std::ranges::any_of(json, [](const Json& one) { return one.is_object(); })) {
        reading.issues.push_back(
            {reading.path,
             "has " + std::to_string(json.size()) + " entries, more than " + std::to_string(most) + " are not read",
             false,
             {}});
        return;
    }
    value.type->resize(value.at, json.size());
    for (std::size_t i = 0; i < json.size(); ++i)
        valueFromJson(value.element(i), json[i], reading.info, reading.issues,
                      joinPointer(reading.path, std::to_string(i)));
}

void mapFromJson(Value value, const Json& json, const Reading& reading) {
    if (!json.is_object()) return wrongType(json, "an object", reading.issues, reading.path);
    value.type->clear(value.at);
    for (const auto& [key, element] : json.items())
        valueFromJson(value.type->insert(value.at, key), element, reading.info, reading.issues,
                      joinPointer(reading.path, key));
}

void optionalFromJson(Value value, const Json& json, const Reading& reading) {
    if (json.is_null()) return value.type->clear(value.at);
    const bool absent = value.inside().at == nullptr;
    if (absent) value.type->emplace(value.at);
    const std::size_t before = reading.issues.size();
    valueFromJson(value.inside(), json, reading.info, reading.issues, reading.path);
    // An issue with the value itself leaves the member unchanged; issues inside of it do not.
    for (std::size_t i = before; absent && i < reading.issues.size(); ++i)
        if (reading.issues[i].path == reading.path) return value.type->clear(value.at);
}

} // namespace

Json valueToJson(Value value, const FieldInfo& info) {
    switch (value.kind()) {
    case ValueKind::Flag:
        return value.number() != 0;
    case ValueKind::Choice:
        return std::string(info.names[static_cast<std::size_t>(value.number())]);
    case ValueKind::Text:
        return value.text();
    case ValueKind::Struct:
    case ValueKind::Variant: {
        Json out = Json::object();
        if (value.kind() == ValueKind::Variant) out["type"] = std::string(value.type->heldName(value.at));
        membersToJson(value.kind() == ValueKind::Variant ? value.inside() : value, out);
        return out;
    }
    case ValueKind::List: {
        Json out = Json::array();
        for (std::size_t i = 0; i < value.size(); ++i) out.push_back(valueToJson(value.element(i), info));
        return out;
    }
    case ValueKind::Map: {
        Json out = Json::object();
        value.type->visitElements(
            value.at, [&](const std::string& key, Value element) { out[key] = valueToJson(element, info); });
        return out;
    }
    case ValueKind::Optional:
        return value.inside().at ? valueToJson(value.inside(), info) : Json(nullptr);
    default:
        return numbersToJson(value);
    }
}

void valueFromJson(Value value, const Json& json, const FieldInfo& info, std::vector<JsonIssue>& issues,
                   const std::string& path) {
    const Reading reading{info, issues, path};
    switch (value.kind()) {
    case ValueKind::Flag:
        if (!json.is_boolean()) return wrongType(json, "true or false", issues, path);
        return value.setNumber(json.get<bool>() ? 1 : 0);
    case ValueKind::Choice:
        if (const auto index = nameFromJson(json, info.names, issues, path)) value.setNumber(static_cast<int>(*index));
        return;
    case ValueKind::Text:
        if (!json.is_string()) return wrongType(json, "a text", issues, path);
        value.text() = json.get<std::string>();
        return;
    case ValueKind::Struct:
        if (!value.type->presets.empty() && json.is_string()) return presetFromJson(value, json, issues, path);
        return structFromJson(value, json, reading);
    case ValueKind::List:
        return listFromJson(value, json, reading);
    case ValueKind::Map:
        return mapFromJson(value, json, reading);
    case ValueKind::Optional:
        return optionalFromJson(value, json, reading);
    case ValueKind::Variant:
        return variantFromJson(value, json, reading);
    case ValueKind::Number:
        return numberFromJson(value, json, reading);
    default:
        return numbersFromJson(value, json, reading);
    }
}

} // namespace tessera::app::detail
