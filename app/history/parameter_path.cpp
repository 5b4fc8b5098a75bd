#include "app/history/parameter_path.h"

#include "app/session/session_types.h"
#include "volume/base/error.h"

#include <algorithm>
#include <charconv>

namespace tessera::app {

namespace detail {

std::string firstKey(std::string_view pointer, std::string_view& rest) {
    if (!pointer.starts_with('/')) {
        rest = {};
        return std::string(pointer);
    }
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    rest = pointer.substr(end);
    std::string key(pointer.substr(1, end - 1));
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"~1", "/"}, {"~0", "~"}})
        for (std::size_t at = 0; (at = key.find(from, at)) != std::string::npos; at += to.size())
            key.replace(at, from.size(), to);
    return key;
}

std::size_t indexOf(const std::string& key, std::size_t size) {
    std::size_t index = 0;
    const auto [end, problem] = std::from_chars(key.data(), key.data() + key.size(), index);
    return problem == std::errc() && end == key.data() + key.size() && index < size ? index : size;
}

namespace {

/// Collects the pointers of single parameters.
void collectPaths(Value value, const std::string& path, std::vector<std::string>& out) {
    switch (value.kind()) {
    case ValueKind::Struct:
        return value.visitMembers(
            [&](Value member, const FieldInfo& info) { collectPaths(member, joinPointer(path, info.key), out); });
    case ValueKind::Variant:
    case ValueKind::Optional:
        if (value.inside().at) collectPaths(value.inside(), path, out);
        return;
    case ValueKind::List:
        if (value.type->elementType().kind == ValueKind::Struct)
            for (std::size_t i = 0; i < value.size(); ++i)
                collectPaths(value.element(i), joinPointer(path, std::to_string(i)), out);
        return;
    case ValueKind::Map:
        return value.type->visitElements(value.at, [&](const std::string& key, Value element) {
            collectPaths(element, joinPointer(path, key), out);
        });
    default:
        out.push_back(path);
    }
}

} // namespace

bool visitPath(Value value, const FieldInfo& info, std::string_view pointer, const VisitMember& visit) {
    if (pointer.empty()) {
        visit(value, info);
        return true;
    }
    std::string_view rest;
    switch (value.kind()) {
    case ValueKind::Struct: {
        const std::string key = firstKey(pointer, rest);
        bool found = false;
        value.visitMembers([&](Value member, const FieldInfo& each) {
            if (!found && each.key == key) found = visitPath(member, each, rest, visit);
        });
        return found;
    }
    case ValueKind::List: {
        const std::size_t index = indexOf(firstKey(pointer, rest), value.size());
        return index < value.size() && visitPath(value.element(index), info, rest, visit);
    }
    case ValueKind::Map: {
        const Value element = value.type->find(value.at, firstKey(pointer, rest));
        return element.at && visitPath(element, info, rest, visit);
    }
    case ValueKind::Variant:
    case ValueKind::Optional:
        return value.inside().at && visitPath(value.inside(), info, pointer, visit);
    default:
        return false; // components of vectors are no parameters of their own
    }
}

} // namespace detail

std::vector<std::string> parameterPaths(const Session& session) {
    std::vector<std::string> all, out;
    detail::collectPaths(valueOf(session), "", all);
    for (const std::string& path : all) {
        const auto under = [&](std::string_view place) { return path.starts_with(place); };
        if (under("/views/") || under("/dock/") || under("/appearance/") || under("/animation/") || under("/data/") ||
            path == "/schema" || path == "/title")
            continue;
        out.push_back(path);
    }
    out.emplace_back("/data/lattice");
    return out;
}

std::vector<std::string> parameterPathsBelow(const Session& session, const std::string& place) {
    std::vector<std::string> all;
    detail::collectPaths(valueOf(session), "", all);
    std::erase_if(all, [&](const std::string& path) { return !path.starts_with(place + "/"); });
    return all;
}

void setInDocument(Json& document, const std::string& path, const std::string& text) {
    Json value = Json::parse(text, nullptr, false);
    if (value.is_discarded()) value = text;
    try {
        const Json::json_pointer pointer(path);
        if (!document.contains(pointer.parent_pointer())) throw Error("no such place in the session", {}, path);
        document[pointer] = std::move(value);
    } catch (const Json::exception&) {
        throw Error("no such place in the session", {}, path);
    }
}

} // namespace tessera::app
