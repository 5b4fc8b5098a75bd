#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tessera {

/// JSON as text, on one line or indented. Names of files need not be UTF-8, as JSON must be: bytes that are not are
/// replaced by U+FFFD.
inline std::string jsonText(const nlohmann::json& json, int indent = -1) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace tessera
