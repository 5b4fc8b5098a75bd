#pragma once

#include "codec/bytes/uncleared.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace tessera::codec {

/// Coefficients in an array of words: `size` of them, contiguous along x.
template <class Word> struct Band {
    Word* values = nullptr;
    const std::uint8_t* present = nullptr; ///< flags with the same layout; null: all present. Absent: neither coded nor
                                           ///< read; 0 when decoded
    glm::ivec3 size{0};
    std::ptrdiff_t rowPitch = 0, slicePitch = 0; ///< words
    int kind = 0; ///< 0 an undivided box, else the bits of the axes along which it holds the high half
};

/// The tokens of bands in coding order, with their contexts: input of both counting and coding.
struct TokenRun {
    static constexpr std::uint16_t kNone = 0xffff;

    /// Sixteen per chunk: kind << 13 | class << 8 | token, kNone where a lane has no coefficient. The kind is that of
    /// the band if the contexts distinguish bands, else 0.
    Uncleared<std::uint16_t> tokens;
    /// Symbols that need raw bits besides their token, and their indices, in order.
    Uncleared<std::uint32_t> large, largeAt;
    int groups = 1, used = 0; ///< of states, and how many states are stored
    bool zero = true;         ///< all coefficients are 0
};

} // namespace tessera::codec
