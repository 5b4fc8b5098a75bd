#pragma once

#include "codec/cpu.h"
#include "codec/rans_model.h"

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
};

/// The tokens of bands in the order of coding, and the contexts they came in: what is counted, and what is coded.
struct TokenRun {
    /// A symbol whose token does not say all of it.
    struct Large {
        std::uint32_t at = 0; ///< of its token
        std::uint32_t symbol = 0;
    };
    static constexpr std::uint16_t kNone = 0xffff;

    std::vector<std::uint16_t> tokens; ///< sixteen a chunk: class << 8 | token, kNone where a lane has no coefficient
    std::vector<Large> large;          ///< in order
    int groups = 1, used = 0;          ///< of states, and how many states are stored
    bool zero = true;                  ///< all coefficients are 0
};

/// Rows of all bands by turns; contexts see magnitudes divided by 2^shift. Every choice of `cpu` gives the same.
template <class Word> TokenRun tokensOf(std::span<const Band<const Word>> bands, int shift, Cpu cpu = bestCpu());

/// Adds the tokens to a histogram, at the contexts of `level`.
void countTokens(const TokenRun& run, int level, Histogram& histogram);

} // namespace tessera::codec
