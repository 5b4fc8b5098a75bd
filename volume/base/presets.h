#pragma once

#include "volume/base/describe.h"

namespace tessera {

/// A described struct with ready-made values to start from, by name: `kPresetNames` and `preset(name)`, nullopt of
/// other names. In JSON the name may stand in place of the object, or in it as "preset", which other keys override.
template <class T>
concept HasPresets = Described<T> && requires(std::string_view name) {
    { T::preset(name) } -> std::same_as<std::optional<T>>;
    { T::kPresetNames[0] } -> std::convertible_to<std::string_view>;
};

} // namespace tessera
