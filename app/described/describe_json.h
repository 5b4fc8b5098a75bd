#pragma once

#include "app/described/value.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
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

Json numberToJson(float value);
Json numberToJson(double value);
Json numberToJson(int value);
/// A JSON pointer with one more key.
std::string joinPointer(const std::string& path, std::string_view key);

Json valueToJson(Value value, const FieldInfo& info);
void valueFromJson(Value value, const Json& json, const FieldInfo& info, std::vector<JsonIssue>& issues,
                   const std::string& path);

} // namespace detail

/// A described struct (or any type a member may have) as JSON. Keys are sorted.
template <class T> Json toJson(const T& value) {
    return detail::valueToJson(valueOf(value), FieldInfo{"", ""});
}

/// Reads a value from a document. A missing key leaves the member unchanged. Unknown keys, wrong types, unknown names
/// and numbers out of range leave it unchanged too, and are pushed to `issues` with their path.
template <class T>
void fromJson(T& value, const Json& json, std::vector<JsonIssue>& issues, const std::string& path = {}) {
    detail::valueFromJson(valueOf(value), json, FieldInfo{"", ""}, issues, path);
}

/// Parses JSON text; throws Error with line and column when it is broken or nested more than 100 deep. `file` only
/// names it.
Json parseJson(std::string_view text, const std::string& file);

/// JSON text with sorted keys, one item per line, arrays of numbers on one line: readable, and easy to compare.
std::string printJson(const Json& json);

} // namespace tessera::app
