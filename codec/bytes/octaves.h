#pragma once

#include "volume/base/cpu.h"

#include <bit>
#include <cstdint>

namespace tessera::codec {

/// Half octaves of value + 1: the exponent and the next bit. For values below 2^31 - 1.
TESSERA_INLINE std::uint32_t halfOctaves(std::uint32_t value) {
    return (std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<std::int32_t>(value + 1))) >> 22) - 254u;
}

} // namespace tessera::codec
