#include "app/history/parameter_path.h"

#include "app/session/session.h"
#include "codec/remote/address.h"
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
struct Paths {
    std::vector<std::string>& out;
    std::string prefix;

    template <class T> void operator()(const T& value, const FieldInfo& info) const {
        collect(value, joinPointer(prefix, info.key));
    }
    template <class T> void collect(const T& value, const std::string& path) const {
        if constexpr (Described<T>) {
            T::describe(value, Paths{out, path});
        } else if constexpr (IsVariant<T>::value) {
            std::visit([&](const auto& own) { collect(own, path); }, value);
        } else if constexpr (IsOptional<T>::value) {
            if (value) collect(*value, path);
        } else if constexpr (IsVector<T>::value) {
            if constexpr (Described<typename T::value_type>)
                for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], joinPointer(path, std::to_string(i)));
        } else if constexpr (IsMap<T>::value) {
            for (const auto& [key, element] : value) collect(element, joinPointer(path, key));
        } else {
            out.push_back(path);
        }
    }
};

} // namespace
} // namespace detail

std::vector<std::string> parameterPaths(const Session& session) {
    std::vector<std::string> all, out;
    detail::Paths{all, ""}.collect(session, "");
    for (const std::string& path : all) {
        const auto under = [&](std::string_view place) { return path.starts_with(place); };
        if (under("/views/") || under("/dock/") || under("/appearance/") || under("/animation/") || under("/data/") ||
            path == "/schema" || path == "/title")
            continue;
        out.push_back(path);
    }
    if (session.data.files.empty() || !codec::namesArchive(session.data.files[0].path))
        out.emplace_back("/data/lattice");
    return out;
}

std::vector<std::string> parameterPathsBelow(const Session& session, const std::string& place) {
    std::vector<std::string> all;
    detail::Paths{all, ""}.collect(session, "");
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
