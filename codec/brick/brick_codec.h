#pragma once

#include "codec/bands/band_coder.h"
#include "codec/brick/brick_format.h"
#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"
#include "codec/wavelet/level_box.h"

#include <array>
#include <span>
#include <vector>

/// Coding of one brick of one component, level by level. (FORMAT.md "Bricks".)
namespace tessera::codec {

/// The tokens of a brick: the part of coding that does not depend on a model.
struct PreparedBrick {
    std::vector<TokenRun> levels;                                 ///< the last is the coarsest
    std::vector<std::uint32_t> exactIndex, exactBits, absentBits; ///< stored in addition
};

/// Working memory of the transform, reused between bricks.
struct SplitMemory {
    std::vector<LevelBox<std::int16_t>> boxes16;
    std::vector<LevelBox<std::int32_t>> boxes32;
};

/// Transforms a brick. `samples` are numbers of format.type, x fastest; `present` has one flag per sample, or is empty:
/// all present. Quantised numbers with an error above `maxError` are stored exactly in addition.
PreparedBrick prepareBrick(const BrickFormat& format, std::span<const std::byte> samples,
                           std::span<const std::uint8_t> present, double maxError, Contexts contexts,
                           SplitMemory& memory);
/// Adds the tokens of a brick to a histogram; long runs are subsampled (countTokens).
void countBrick(const PreparedBrick& brick, Histogram& histogram, int every = 1);

/// Codes a brick: segment 0 has the coarsest level, segment i the details of level `levels - 1 - i`. `brick` must be
/// prepared from the same samples with the contexts of the model. Deterministic.
std::vector<Bytes> encodeBrick(const BrickFormat& format, const PreparedBrick& brick,
                               std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                               Compressor& compressor, const BandEncoder& bands);

/// prepareBrick and encodeBrick in one call.
std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor,
                               const BandEncoder& bands);

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
    std::vector<std::uint8_t> present; ///< flags at the level; empty: all present
    std::vector<ExactSample> exact;    ///< full resolution only: samples that replace those of their codes
    std::vector<std::uint32_t> absent; ///< full resolution only: bits of absent samples in storage order, if stored

    /// Resets to the shape of a level.
    void begin(const BrickFormat& format, int level);
    template <class Word> Boxes<Word>& boxes() {
        if constexpr (sizeof(Word) == 2)
            return boxes16;
        else
            return boxes32;
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

/// Decodes `level` from the segments up to it (levels - level segments, coarsest first). Never throws because of the
/// contents of the bytes and never reads beyond them.
DecodeStatus decodeBrick(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                         std::span<const std::uint8_t> present, const BandDecoder& bands, DecodedBrick& out);

} // namespace tessera::codec
