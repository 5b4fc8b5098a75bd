#pragma once

#include "codec/bands/adaptive_bands.h"
#include "codec/bands/fitted_bands.h"
#include "codec/brick/brick_format.h"
#include "codec/bytes/decode_status.h"
#include "codec/wavelet/level_box.h"

#include <array>
#include <span>
#include <vector>

/// What a reader gets of a brick: codes of a level, and what is stored in addition.
namespace tessera::codec {

/// A sample stored exactly as its bits, replacing the value of its code.
struct ExactSample {
    std::uint32_t index = 0, bits = 0;
};

/// One decoded level of a brick. Its memory is reused when decoding into it again.
struct DecodedBrick {
    /// Boxes of the sublattices; all except `samples` are working memory.
    template <class Word> struct Boxes { std::array<LevelBox<Word>, 2> samples, details, spare; };

    glm::ivec3 size{0}; ///< storage samples at the level
    int sublattices = 1;
    bool narrow = false; ///< the codes are in `boxes16`, else in `boxes32`
    Boxes<std::int16_t> boxes16;
    Boxes<std::int32_t> boxes32;
    std::vector<std::uint8_t> present;     ///< flags at the level; empty: all present
    std::vector<std::uint32_t> subsamples; ///< of subsampled bricks, see takeSubsamples
    std::vector<ExactSample> exact;        ///< full resolution only: samples that replace those of their codes
    std::vector<std::uint32_t> absent;     ///< full resolution only: bits of absent samples in storage order, if stored
    std::vector<Correction> corrections;   ///< working memory, as are the next two
    FittedMemory<std::int16_t> fitted16;
    FittedMemory<std::int32_t> fitted32;

    /// Resets to the shape of a level.
    void begin(const BrickFormat& format, int level);
    template <class Word> Boxes<Word>& boxes() {
        if constexpr (sizeof(Word) == 2)
            return boxes16;
        else
            return boxes32;
    }
    template <class Word> FittedMemory<Word>& fitted() {
        if constexpr (sizeof(Word) == 2)
            return fitted16;
        else
            return fitted32;
    }
    /// Calls `visit(index of the first sample, codes)` for each row in storage order, with a span of 16- or 32-bit
    /// codes; undefined where absent.
    template <class Visit> void forRows(Visit&& visit) const {
        const auto rows = [&](const auto& samples) {
            std::size_t first = 0;
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y, first += std::size_t(size.x))
                    visit(first, std::span(samples[std::size_t(z % sublattices)].box().row(y, z / sublattices),
                                           std::size_t(size.x)));
        };
        narrow ? rows(boxes16.samples) : rows(boxes32.samples);
    }
    /// All codes in storage order.
    std::vector<std::uint32_t> codes() const;
};

/// Decodes the streams of absent and exact samples of full resolution at the front of `in`, and advances it.
DecodeStatus decodeExtras(const BrickFormat& format, std::span<const std::uint8_t> present,
                          std::span<const std::byte>& in, DecodedBrick& out);

} // namespace tessera::codec
