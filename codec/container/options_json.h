#pragma once

#include "codec/container/pack_options.h"

#include <nlohmann/json_fwd.hpp>

namespace tessera::codec {

/// Options that differ from their defaults, by key; enumerators by name, nested options as objects.
nlohmann::json toJson(const PackOptions& options);
/// Inverse of toJson. Tolerant: a missing or unknown key, a wrong type or a number out of range keeps the default.
PackOptions optionsFromJson(const nlohmann::json& json);

} // namespace tessera::codec
