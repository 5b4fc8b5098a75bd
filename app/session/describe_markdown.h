#pragma once

#include "app/described/describe_json.h"

#include <string>

/// The reference of settings (docs/settings.md), written from the same descriptions as widgets, JSON and options.
namespace tessera::app {

namespace detail {

std::string markdownRows(Value value);

} // namespace detail

/// A section with a table of every member of a described struct; members of nested structs appear as "outer.inner".
template <Described T> std::string markdownSection(const std::string& title, const std::string& text) {
    const T defaults{};
    const std::string rows = detail::markdownRows(valueOf(defaults));
    const std::string head = "## " + title + "\n\n" + text + "\n\n";
    if (rows.empty()) return head + "No settings.\n\n";
    return head + "| key | default | range | unit | meaning |\n|---|---|---|---|---|\n" + rows + "\n";
}

/// The whole reference page.
std::string parameterReference();

} // namespace tessera::app
