#pragma once

#include "codec/bands/rans_model.h"
#include "codec/bytes/cpu.h"
#include "codec/bytes/uncleared.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::codec {

/// Coefficients within an array of words: `size` of them, x one behind the other.
template <class Word> struct Band {
    Word* values = nullptr;
    const std::uint8_t* present = nullptr; ///< flags with the same layout; null: all present. Absent: neither coded nor
                                           ///< read; 0 when decoded
    glm::ivec3 size{0};
    std::ptrdiff_t rowPitch = 0, slicePitch = 0; ///< words
    int kind = 0; ///< 0 an undivided box, else the bits of the axes along which it holds the high half
};

/// The tokens of bands in the order of coding, and the contexts they came in: what is counted, and what is coded.
struct TokenRun {
    static constexpr std::uint16_t kNone = 0xffff;

    /// Sixteen a chunk: kind << 13 | class << 8 | token, kNone where a lane has no coefficient. The kind is that of the
    /// band where contexts ask for it, else 0.
    Uncleared<std::uint16_t> tokens;
    /// Symbols whose tokens do not say all of them, and the numbers of those, in order.
    Uncleared<std::uint32_t> large, largeAt;
    int groups = 1, used = 0; ///< of states, and how many states are stored
    bool zero = true;         ///< all coefficients are 0
};

/// Rows of all bands by turns. Every choice of `cpu` gives the same.
template <class Word>
TokenRun tokensOf(std::span<const Band<const Word>> bands, Contexts contexts, Cpu cpu = bestCpu());

/// Adds the tokens to a histogram of the same contexts, at `level`; of long runs `every` so many chunks, which stand
/// for the others.
void countTokens(const TokenRun& run, int level, Histogram& histogram, int every = 1);

} // namespace tessera::codec
