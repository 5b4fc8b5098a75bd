#pragma once

#include "codec/cpu.h"
#include "codec/rans_model.h"

#include <cstddef>
#include <glm/vec3.hpp>

/// Bands of integer coefficients to bytes: interleaved rANS whose contexts are the magnitudes of the row and the slice
/// before, never the left neighbour, so that sixteen lanes along x decode side by side.
///
/// Duda: Asymmetric numeral systems (2013); Giesen: Interleaved entropy coders (2014). A half octave of the neighbours'
/// magnitude as the context is from Wu and Memon: CALIC (1997). (FORMAT.md "Bands".)
namespace tessera::codec {

/// Coefficients within an array of words: `size` of them, x one behind the other.
template <class Word> struct Band {
    Word* values = nullptr;
    const std::uint8_t* present = nullptr; ///< flags with the same layout; null: all present. Absent: neither coded nor
                                           ///< read; 0 when decoded
    glm::ivec3 size{0};
    std::ptrdiff_t rowPitch = 0, slicePitch = 0; ///< words
};

/// Adds the tokens of bands to a histogram, at the contexts of `level`.
template <class Word>
void countTokens(std::span<const Band<const Word>> bands, int level, int shift, Histogram& histogram);

/// The model laid out for encoding; one for all bricks of a frame.
class BandEncoder {
public:
    explicit BandEncoder(Model model);
    const Model& model() const { return model_; }
    /// Appends the bands, rows of all bands by turns; nothing when all coefficients are 0. Any value can be coded.
    template <class Word> void encode(std::span<const Band<const Word>> bands, int level, Bytes& out) const;

    struct Entry {
        std::uint64_t reciprocal = 0;
        std::uint32_t frequency = 0, start = 0;
    };

private:
    Model model_;
    std::vector<Entry> entries_; ///< [table << 8 | token]
};

/// The model laid out for decoding; one for all bricks of a frame, used from any thread.
class BandDecoder {
public:
    explicit BandDecoder(Model model);
    const Model& model() const { return model_; }
    /// Fills the bands from exactly these bytes. Values beyond a Word are cut to it.
    template <class Word>
    DecodeStatus decode(std::span<const std::byte> in, std::span<const Band<Word>> bands, int level,
                        Cpu cpu = bestCpu()) const;

private:
    Model model_;
    std::vector<std::uint32_t> table_;
};

} // namespace tessera::codec
