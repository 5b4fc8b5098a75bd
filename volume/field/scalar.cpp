#include "volume/field/scalar.h"

#include <array>

namespace tessera::volume {

namespace {
struct Word {
    ScalarType type;
    std::string_view longName, shortName;
    std::size_t bytes;
};
constexpr std::array kWords{Word{ScalarType::U8, "uint8", "u8", 1}, Word{ScalarType::I16, "int16", "i16", 2},
                            Word{ScalarType::U16, "uint16", "u16", 2}, Word{ScalarType::I32, "int32", "i32", 4},
                            Word{ScalarType::F32, "float32", "f32", 4}};
} // namespace

std::string_view name(ScalarType type) {
    return kWords[static_cast<std::size_t>(type)].longName;
}

std::optional<ScalarType> parseScalarType(std::string_view word) {
    for (const Word& known : kWords)
        if (word == known.longName || word == known.shortName) return known.type;
    return std::nullopt;
}

std::size_t byteSize(ScalarType type) {
    return kWords[static_cast<std::size_t>(type)].bytes;
}

ScalarType commonType(ScalarType a, ScalarType b) {
    if (a == b || b == ScalarType::U8) return a;
    if (a == ScalarType::U8) return b;
    const bool anyFloat = a == ScalarType::F32 || b == ScalarType::F32;
    return anyFloat ? ScalarType::F32 : ScalarType::I32; // int16 and uint16, or int32 and a shorter one
}

} // namespace tessera::volume
