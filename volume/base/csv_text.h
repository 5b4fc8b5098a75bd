#pragma once

#include <string>

namespace tessera {

/// A text as one field of a CSV line: quoted where it holds what would end it.
inline std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

} // namespace tessera
