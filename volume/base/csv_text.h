#pragma once

#include "volume/base/printable.h"

#include <cstdlib>
#include <string>

namespace tessera {

/// A text as one field of a CSV line: quoted where it holds what would end it. Programs for tables compute cells that
/// begin with = + - or @, with commands of whoever named a parameter so: such a text gets an apostrophe before it,
/// unless it is a number.
inline std::string csvField(const std::string& text) {
    std::string shown = printable(text);
    if (!shown.empty() && std::string("=+-@").find(shown.front()) != std::string::npos) {
        char* end = nullptr;
        (void)std::strtod(shown.c_str(), &end);
        if (end != shown.c_str() + shown.size()) shown.insert(0, 1, '\'');
    }
    if (shown.find_first_of(",\"") == std::string::npos) return shown;
    std::string quoted = "\"";
    for (const char c : shown) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

} // namespace tessera
