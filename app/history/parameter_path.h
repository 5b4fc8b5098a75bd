#pragma once

#include "app/described/describe_json.h"

#include <string>
#include <string_view>

/// Access to one setting of a struct by its JSON pointer.
namespace tessera::app {

namespace detail {

/// Splits the first key off a pointer ("/a/b" -> "a", "/b"), escapes undone.
std::string firstKey(std::string_view pointer, std::string_view& rest);
/// A key as an index below `size`, else `size`.
std::size_t indexOf(const std::string& key, std::size_t size);

bool visitPath(Value value, const FieldInfo& info, std::string_view pointer, const VisitMember& visit);

} // namespace detail

/// Calls visit(member, FieldInfo) for the member that a JSON pointer names; false if there is none. Lists and maps are
/// entered by index and key, variants directly.
template <class T> bool visitParameter(T& value, std::string_view pointer, const VisitMember& visit) {
    return detail::visitPath(valueOf(value), FieldInfo{"", ""}, pointer, visit);
}

struct Session;

/// The paths of all settings of a session that users can set one by one: numbers, switches, choices, texts; except
/// those of the window (views, dock, appearance) and of playing.
std::vector<std::string> parameterPaths(const Session& session);

/// Those of one place of the session, such as "/data/packed".
std::vector<std::string> parameterPathsBelow(const Session& session, const std::string& place);

/// Sets "/json/pointer" of a document to a value given as JSON, or as text where it is none. Throws Error where the
/// parent does not exist.
void setInDocument(Json& document, const std::string& path, const std::string& text);

} // namespace tessera::app
