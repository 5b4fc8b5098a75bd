#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace tessera::volume {

/// The number types a stored sample can have, little-endian.
enum class ScalarType : std::uint8_t { U8, I16, U16, I32, F32 };

/// "uint8", "int16", "uint16", "int32", "float32": the words of sidecars and of `info --json`.
std::string_view name(ScalarType type);

/// Accepts the words above and the short forms u8, i16, u16, i32, f32.
std::optional<ScalarType> parseScalarType(std::string_view word);

/// Bytes of one sample.
std::size_t byteSize(ScalarType type);

/// The smallest type that holds the numbers of both: integers exactly. Beside a float it is float, which rounds
/// integers beyond 2^24.
ScalarType commonType(ScalarType a, ScalarType b);

/// Calls `function(T{})` with T the C++ type of `type` and returns its result.
template <class Function> decltype(auto) dispatch(ScalarType type, Function&& function) {
    switch (type) {
    case ScalarType::U8:
        return std::forward<Function>(function)(std::uint8_t{});
    case ScalarType::I16:
        return std::forward<Function>(function)(std::int16_t{});
    case ScalarType::U16:
        return std::forward<Function>(function)(std::uint16_t{});
    case ScalarType::I32:
        return std::forward<Function>(function)(std::int32_t{});
    case ScalarType::F32:
        break;
    }
    return std::forward<Function>(function)(float{});
}

/// The ScalarType of a C++ type.
template <class T> constexpr ScalarType scalarTypeOf() {
    if constexpr (std::same_as<T, std::uint8_t>)
        return ScalarType::U8;
    else if constexpr (std::same_as<T, std::int16_t>)
        return ScalarType::I16;
    else if constexpr (std::same_as<T, std::uint16_t>)
        return ScalarType::U16;
    else if constexpr (std::same_as<T, std::int32_t>)
        return ScalarType::I32;
    else {
        static_assert(std::same_as<T, float>);
        return ScalarType::F32;
    }
}

} // namespace tessera::volume
