#pragma once

#include "app/described/describe_json.h"

#include <string>

/// The reference of settings (docs/settings.md), written from the same descriptions as widgets, JSON and options.
namespace tessera::app {

namespace detail {

/// One row of a table: key, default, range or choices, unit, help.
void appendRow(std::string& out, const std::string& key, const FieldInfo& info, const Json& value);

struct MarkdownRows {
    std::string& out;
    std::string prefix;
    template <class T> void operator()(const T& value, const FieldInfo& info) const {
        const std::string key = prefix + std::string(info.key);
        if constexpr (Described<T>)
            T::describe(value, MarkdownRows{out, key + "."});
        else
            appendRow(out, key, info, valueToJson(value, info));
    }
};

} // namespace detail

/// A section with a table of every member of a described struct; members of nested structs appear as "outer.inner".
template <Described T> std::string markdownSection(const std::string& title, const std::string& text) {
    std::string out = "## " + title + "\n\n" + text + "\n\n";
    std::string rows;
    const T defaults{};
    T::describe(defaults, detail::MarkdownRows{rows, ""});
    if (rows.empty()) return out + "No settings.\n\n";
    return out + "| key | default | range | unit | meaning |\n|---|---|---|---|---|\n" + rows + "\n";
}

/// The whole reference page.
std::string parameterReference();

} // namespace tessera::app
