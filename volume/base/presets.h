#pragma once

#include "volume/base/describe.h"

namespace tessera {

/// A described struct with presets: `kPresetNames` and `preset(name)`, nullopt for other names. In JSON the name can
/// replace the object, or be its key "preset", which other keys override.
template <class T>
concept HasPresets = Described<T> && requires(std::string_view name) {
    { T::preset(name) } -> std::same_as<std::optional<T>>;
    { T::kPresetNames[0] } -> std::convertible_to<std::string_view>;
};

} // namespace tessera
