#pragma once

#include "volume/base/presets.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

/// JSON of everything that is described: objects with the described keys, variants with a "type" member, enumerators by
/// name, vectors and quaternions (w, x, y, z) as arrays, floats as the shortest number that reads back equal, numbers
/// JSON lacks as "nan", "inf", "-inf".
namespace tessera::app {

using Json = nlohmann::json;

/// A part of a document that was ignored.
struct JsonIssue {
    std::string path;   ///< JSON pointer
    std::string reason; ///< one line
    bool unknownKey = false;
    Json value; ///< the value of an unknown key
};

namespace detail {

template <class T> struct IsVector : std::false_type {};
template <class T> struct IsVector<std::vector<T>> : std::true_type {};
template <class T> struct IsMap : std::false_type {};
template <class T> struct IsMap<std::map<std::string, T>> : std::true_type {};
template <class T> struct IsOptional : std::false_type {};
template <class T> struct IsOptional<std::optional<T>> : std::true_type {};
template <class T> struct IsVariant : std::false_type {};
template <class... Ts> struct IsVariant<std::variant<Ts...>> : std::true_type {};
template <class T> struct GlmLength : std::integral_constant<int, 0> {};
template <int N, class T, glm::qualifier Q> struct GlmLength<glm::vec<N, T, Q>> : std::integral_constant<int, N> {};
template <class T> struct IsQuat : std::false_type {};
template <class T, glm::qualifier Q> struct IsQuat<glm::qua<T, Q>> : std::true_type {};

Json numberToJson(float value);
Json numberToJson(double value);
Json numberToJson(int value);
/// Reads a number. If it is not a number, out of range or not exact for its type, pushes an issue and returns nothing.
std::optional<double> numberFromJson(const Json& json, const FieldInfo& info, bool integer,
                                     std::vector<JsonIssue>& issues, const std::string& path);
std::optional<std::size_t> nameFromJson(const Json& json, std::span<const std::string_view> names,
                                        std::vector<JsonIssue>& issues, const std::string& path);
void wrongType(const Json& json, std::string_view wanted, std::vector<JsonIssue>& issues, const std::string& path);
/// A JSON pointer with one more key.
std::string joinPointer(const std::string& path, std::string_view key);

template <class T> Json valueToJson(const T& value, const FieldInfo& info);
template <class T>
void valueFromJson(T& value, const Json& json, const FieldInfo& info, std::vector<JsonIssue>& issues,
                   const std::string& path);

struct MemberToJson {
    Json& out;
    template <class T> void operator()(const T& value, const FieldInfo& info) const {
        out[std::string(info.key)] = valueToJson(value, info);
    }
};

struct MemberFromJson {
    const Json& in;
    std::vector<std::string_view>& known;
    std::vector<JsonIssue>& issues;
    const std::string& path;
    template <class T> void operator()(T& value, const FieldInfo& info) const {
        known.push_back(info.key);
        const auto found = in.find(info.key);
        if (found != in.end()) valueFromJson(value, *found, info, issues, joinPointer(path, info.key));
    }
};

void reportUnknown(const Json& json, const std::vector<std::string_view>& known, std::vector<JsonIssue>& issues,
                   const std::string& path);

template <class T>
void membersFromJson(T& value, const Json& json, std::vector<std::string_view> known, std::vector<JsonIssue>& issues,
                     const std::string& path) {
    T::describe(value, MemberFromJson{json, known, issues, path});
    reportUnknown(json, known, issues, path);
}

template <class... Ts> std::string typeNames(const std::variant<Ts...>*) {
    std::string all;
    ((all += (all.empty() ? "" : ", ") + std::string(Ts::kType)), ...);
    return all;
}

template <class... Ts>
void variantFromJson(std::variant<Ts...>& value, const Json& json, std::vector<JsonIssue>& issues,
                     const std::string& path) {
    const auto type = json.is_object() ? json.find("type") : json.end();
    if (!json.is_object() || type == json.end() || !type->is_string()) {
        issues.push_back({path, "needs an object with a \"type\"", false, {}});
        return;
    }
    const auto& wanted = type->template get_ref<const std::string&>();
    const bool found = ([&]<class A>(std::type_identity<A>) {
        if (wanted != A::kType) return false;
        if (!std::holds_alternative<A>(value)) value = A{};
        membersFromJson(std::get<A>(value), json, {"type"}, issues, path);
        return true;
    }(std::type_identity<Ts>{}) ||
                        ...);
    if (!found)
        issues.push_back(
            {joinPointer(path, "type"), "unknown type \"" + wanted + "\"; known are " + typeNames(&value), false, {}});
}

template <HasPresets T>
void presetFromJson(T& value, const Json& json, std::vector<JsonIssue>& issues, const std::string& path) {
    if (const auto index = nameFromJson(json, T::kPresetNames, issues, path))
        value = *T::preset(T::kPresetNames[*index]);
}

template <class T> Json valueToJson(const T& value, const FieldInfo& info) {
    if constexpr (Described<T>) {
        Json out = Json::object();
        T::describe(value, MemberToJson{out});
        return out;
    } else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
        return value;
    } else if constexpr (std::is_enum_v<T>) {
        return std::string(info.names[static_cast<std::size_t>(value)]);
    } else if constexpr (std::is_arithmetic_v<T>) {
        return numberToJson(value);
    } else if constexpr (std::is_same_v<T, Range>) {
        return Json::array({numberToJson(value.lo), numberToJson(value.hi)});
    } else if constexpr (GlmLength<T>::value > 0) {
        Json out = Json::array();
        for (int i = 0; i < GlmLength<T>::value; ++i) out.push_back(numberToJson(value[i]));
        return out;
    } else if constexpr (IsQuat<T>::value) {
        return Json::array(
            {numberToJson(value.w), numberToJson(value.x), numberToJson(value.y), numberToJson(value.z)});
    } else if constexpr (IsVector<T>::value) {
        Json out = Json::array();
        for (const auto& element : value) out.push_back(valueToJson(element, info));
        return out;
    } else if constexpr (IsMap<T>::value) {
        Json out = Json::object();
        for (const auto& [key, element] : value) out[key] = valueToJson(element, info);
        return out;
    } else if constexpr (IsOptional<T>::value) {
        return value ? valueToJson(*value, info) : Json(nullptr);
    } else {
        static_assert(IsVariant<T>::value, "describe: no JSON for this type of member");
        return std::visit(
            [](const auto& alternative) {
                using A = std::decay_t<decltype(alternative)>;
                Json out = Json::object();
                out["type"] = std::string(A::kType);
                A::describe(alternative, MemberToJson{out});
                return out;
            },
            value);
    }
}

/// Reads a range, vector or quaternion: an array of its numbers, all of them or none.
template <class T>
void numbersFromJson(T& value, const Json& json, const FieldInfo& info, std::vector<JsonIssue>& issues,
                     const std::string& path) {
    constexpr std::size_t count = std::is_same_v<T, Range> ? 2 : IsQuat<T>::value ? 4 : GlmLength<T>::value;
    if (!json.is_array() || json.size() != count)
        return wrongType(json, "an array of " + std::to_string(count) + " numbers", issues, path);
    double parts[count];
    for (std::size_t i = 0; i < count; ++i) {
        const auto part = numberFromJson(json[i], info, false, issues, joinPointer(path, std::to_string(i)));
        if (!part) return;
        parts[i] = *part;
    }
    if constexpr (std::is_same_v<T, Range>) {
        value = {parts[0], parts[1]};
    } else if constexpr (IsQuat<T>::value) {
        using V = typename T::value_type;
        value =
            T(static_cast<V>(parts[0]), static_cast<V>(parts[1]), static_cast<V>(parts[2]), static_cast<V>(parts[3]));
    } else {
        using V = typename T::value_type;
        for (std::size_t i = 0; i < count; ++i)
            value[static_cast<typename T::length_type>(i)] = static_cast<V>(parts[i]);
    }
}

template <class T>
void valueFromJson(T& value, const Json& json, const FieldInfo& info, std::vector<JsonIssue>& issues,
                   const std::string& path) {
    if constexpr (HasPresets<T>) {
        if (json.is_string()) return presetFromJson(value, json, issues, path);
    }
    if constexpr (Described<T>) {
        if (!json.is_object()) return wrongType(json, "an object", issues, path);
        std::vector<std::string_view> known;
        if constexpr (HasPresets<T>) {
            if (const auto name = json.find("preset"); name != json.end()) {
                presetFromJson(value, *name, issues, joinPointer(path, "preset"));
                known.emplace_back("preset");
            }
        }
        membersFromJson(value, json, std::move(known), issues, path);
    } else if constexpr (std::is_same_v<T, bool>) {
        if (!json.is_boolean()) return wrongType(json, "true or false", issues, path);
        value = json.get<bool>();
    } else if constexpr (std::is_same_v<T, std::string>) {
        if (!json.is_string()) return wrongType(json, "a text", issues, path);
        value = json.get<std::string>();
    } else if constexpr (std::is_enum_v<T>) {
        if (const auto index = nameFromJson(json, info.names, issues, path)) value = static_cast<T>(*index);
    } else if constexpr (std::is_arithmetic_v<T>) {
        if (const auto number = numberFromJson(json, info, std::is_integral_v<T>, issues, path)) {
            if constexpr (std::is_same_v<T, float>) {
                if (std::abs(*number) > double(std::numeric_limits<float>::max()) && !std::isinf(*number)) {
                    issues.push_back({path, "too large", false, {}});
                    return;
                }
            }
            value = static_cast<T>(*number);
        }
    } else if constexpr (std::is_same_v<T, Range> || GlmLength<T>::value > 0 || IsQuat<T>::value) {
        numbersFromJson(value, json, info, issues, path);
    } else if constexpr (IsVector<T>::value) {
        if (!json.is_array()) return wrongType(json, "an array", issues, path);
        T result(json.size());
        for (std::size_t i = 0; i < json.size(); ++i)
            valueFromJson(result[i], json[i], info, issues, joinPointer(path, std::to_string(i)));
        value = std::move(result);
    } else if constexpr (IsMap<T>::value) {
        if (!json.is_object()) return wrongType(json, "an object", issues, path);
        T result;
        for (const auto& [key, element] : json.items())
            valueFromJson(result[key], element, info, issues, joinPointer(path, key));
        value = std::move(result);
    } else if constexpr (IsOptional<T>::value) {
        if (json.is_null()) {
            value.reset();
        } else {
            typename T::value_type inner = value ? *value : typename T::value_type{};
            const std::size_t before = issues.size();
            valueFromJson(inner, json, info, issues, path);
            // An issue with the value itself leaves the member unchanged; issues inside of it do not.
            for (std::size_t i = before; i < issues.size(); ++i)
                if (issues[i].path == path) return;
            value = std::move(inner);
        }
    } else {
        static_assert(IsVariant<T>::value, "describe: no JSON for this type of member");
        variantFromJson(value, json, issues, path);
    }
}

} // namespace detail

/// A described struct (or any type a member may have) as JSON. Keys are sorted.
template <class T> Json toJson(const T& value) {
    return detail::valueToJson(value, FieldInfo{.key = "", .unit = "", .doc = ""});
}

/// Reads a value from a document. A missing key leaves the member unchanged. Unknown keys, wrong types, unknown names
/// and numbers out of range leave it unchanged too, and are pushed to `issues` with their path.
template <class T>
void fromJson(T& value, const Json& json, std::vector<JsonIssue>& issues, const std::string& path = {}) {
    detail::valueFromJson(value, json, FieldInfo{.key = "", .unit = "", .doc = ""}, issues, path);
}

/// Parses JSON text; throws Error with line and column when it is broken or nested more than 100 deep. `file` only
/// names it.
Json parseJson(std::string_view text, const std::string& file);

/// JSON text with sorted keys, one item per line, arrays of numbers on one line: readable, and easy to compare.
std::string printJson(const Json& json);

} // namespace tessera::app
