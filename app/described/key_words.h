#pragma once

#include <string>
#include <string_view>

namespace tessera::app {

/// What users read for a key or enumerator of the session: camel case as separate lower-case words, with those replaced
/// that texts do not use. "contextOpacity" -> "context opacity", "channel" -> "parameter".
std::string keyWords(std::string_view key);

/// The same for one of what a list holds. "clips" -> "clip".
std::string oneOf(std::string_view list);

/// Whether two texts name the same, however they are spelled: "shadowCube", "shadow_cube", "Shadow cube".
bool sameName(std::string_view a, std::string_view b);

} // namespace tessera::app
