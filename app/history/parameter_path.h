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

template <class T, class Visit> struct MemberAt {
    const std::string& key;
    std::string_view rest;
    Visit& visit;
    bool& found;
    template <class M> void operator()(M& member, const FieldInfo& info) const;
};

template <class T, class Visit>
bool visitPath(T& value, const FieldInfo& info, std::string_view pointer, Visit& visit) {
    using V = std::remove_const_t<T>;
    if (pointer.empty()) {
        visit(value, info);
        return true;
    }
    if constexpr (Described<V>) {
        std::string_view rest;
        const std::string key = firstKey(pointer, rest);
        bool found = false;
        V::describe(value, MemberAt<V, Visit>{key, rest, visit, found});
        return found;
    } else if constexpr (IsVariant<V>::value) {
        return std::visit([&](auto& alternative) { return visitPath(alternative, info, pointer, visit); }, value);
    } else if constexpr (IsVector<V>::value) {
        std::string_view rest;
        const std::size_t index = indexOf(firstKey(pointer, rest), value.size());
        return index < value.size() && visitPath(value[index], info, rest, visit);
    } else if constexpr (IsMap<V>::value) {
        std::string_view rest;
        const auto at = value.find(firstKey(pointer, rest));
        return at != value.end() && visitPath(at->second, info, rest, visit);
    } else if constexpr (IsOptional<V>::value) {
        return value && visitPath(*value, info, pointer, visit);
    } else {
        return false; // components of vectors are no parameters of their own
    }
}

template <class T, class Visit>
template <class M>
void MemberAt<T, Visit>::operator()(M& member, const FieldInfo& info) const {
    if (!found && info.key == key) found = visitPath(member, info, rest, visit);
}

} // namespace detail

/// Calls visit(member, FieldInfo) for the member that a JSON pointer names; false if there is none. Lists and maps are
/// entered by index and key, variants directly.
template <class T, class Visit> bool visitParameter(T& value, std::string_view pointer, Visit&& visit) {
    return detail::visitPath(value, FieldInfo{.key = "", .unit = "", .doc = ""}, pointer, visit);
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
