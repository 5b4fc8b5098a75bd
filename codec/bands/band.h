#pragma once

#include "codec/bytes/uncleared.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace tessera::codec {

/// A subband of coefficients: `size` words, contiguous along x.
template <class Word> struct Band {
    Word* values = nullptr;
    const std::uint8_t* present =
        nullptr; ///< flags with the same layout; null: all present. Absent coefficients are not coded; 0 when decoded
    glm::ivec3 size{0};
    std::ptrdiff_t rowPitch = 0, slicePitch = 0; ///< in words
    int kind = 0; ///< 0 for an undivided box, else the bits of the axes along which it is the high half
    int turn = 0; ///< bands with the same turn are coded row by row in turns, after those of lower turns; those
                  ///< that are predicted have turns of their own
};

/// What is known of a row of a band that is predicted from others, until the next call of its predictor.
template <class Word> struct PredictedRow {
    /// Is added to the magnitudes of neighbours for the contexts of the row, at most 16383; room for two whole chunks
    /// follows. Null: nothing.
    const std::uint16_t* activity = nullptr;
    const Word* values = nullptr; ///< in reading: is added to what is decoded; null: nothing
};

/// Predicts the rows of bands.
template <class Word> class RowPredictor {
public:
    virtual ~RowPredictor() = default;
    /// Called before row y of slice z of a band is coded or decoded.
    virtual PredictedRow<Word> begin(std::size_t band, int z, int y) = 0;
    /// Called when the row has been coded or decoded.
    virtual void end(std::size_t band, int z, int y) = 0;
};

/// The tokens of bands in coding order with their contexts; input of both counting and coding.
struct TokenRun {
    static constexpr std::uint16_t kNone = 0xffff;

    /// Sixteen per chunk: kind << 13 | class << 8 | token, kNone in lanes without a coefficient. The kind is that of
    /// the band if contexts are by band, else 0.
    Uncleared<std::uint16_t> tokens;
    /// Symbols that need raw bits besides their token, and the indices of their tokens, in order.
    Uncleared<std::uint32_t> large, largeAt;
    int groups = 1, used = 0; ///< groups of coder states, and number of stored states
    bool zero = true;         ///< all coefficients are 0
};

} // namespace tessera::codec
