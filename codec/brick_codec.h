#pragma once

#include "codec/band_coder.h"
#include "codec/decode_status.h"
#include "codec/entropy.h"
#include "codec/lifting.h"
#include "codec/numbers.h"
#include "volume/lattice.h"

#include <span>
#include <vector>

/// One brick of one component: samples to bytes, level by level, and back. (FORMAT.md "Bricks".)
namespace tessera::codec {

/// All that a decoder must know before it reads the bytes of a brick.
struct BrickFormat {
    volume::LatticeKind kind = volume::LatticeKind::CC;
    glm::ivec3 size{1}; ///< storage samples of the brick at full resolution; a BCC brick starts on an even slice
    int levels = 1;
    Wavelet wavelet = Wavelet::W22;
    volume::ScalarType type = volume::ScalarType::F32;
    NumberCoding numbers;
    bool keepsAbsent = false; ///< the stored numbers of absent samples are coded as well
    int codeBits = 32;        ///< every |code| is below 2^codeBits; narrow ones are faster

    bool operator==(const BrickFormat&) const = default;

    int sublattices() const { return kind == volume::LatticeKind::BCC ? 2 : 1; }
    /// Full-resolution samples of one sublattice of the brick.
    glm::ivec3 sublatticeSize(int sublattice) const;
    /// True when samples may be stored beside the codes.
    bool canHaveExact() const;
};

/// Bits of the codes of a type whose numbers are the codes.
int codeBitsOf(volume::ScalarType type);

inline std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// Storage samples of the brick at a level.
glm::ivec3 samplesAt(const BrickFormat& format, int level);
/// Every 2^level-th flag of each sublattice: what is present at a level. Empty in, empty out.
std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level);

/// Arithmetic of the lifting, and its wavelet: floats are only predicted, as an update would mix exponents and
/// overshoot by powers of two.
Arithmetic arithmeticOf(const BrickFormat& format);
Wavelet effectiveWavelet(const BrickFormat& format);

/// Adds the tokens of a brick to the statistics a model is made of. `samples` and `present` as for encodeBrick.
void countBrick(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                int shift, Histogram& histogram);

/// The coded brick: segment 0 holds the coarsest level, segment i what level `levels - 1 - i` adds. `samples` are
/// numbers of format.type, x fastest; `present` one flag each, or empty: all. Quantised numbers off by more than
/// `maxError` are stored exactly. Same input, same bytes.
std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor,
                               const BandEncoder& bands);

/// A sample stored as its bits beside the codes.
struct ExactSample {
    std::uint32_t index = 0, bits = 0;
};

struct DecodedBrick {
    std::vector<std::uint32_t> codes;  ///< storage order of the level; undefined where absent
    std::vector<std::uint8_t> present; ///< flags at the level; empty: all present
    std::vector<ExactSample> exact;    ///< full resolution only: samples that replace their codes
    std::vector<std::uint32_t> absent; ///< full resolution only: bits of absent samples in order, if kept
};

/// Decodes `level` from the segments up to it (levels - level of them, coarsest first). Never throws for what the bytes
/// say, never reads beyond them.
DecodeStatus decodeBrick(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                         std::span<const std::uint8_t> present, const BandDecoder& bands, DecodedBrick& out);

/// The streams of absent and exact samples of full resolution, from the front of `in`.
DecodeStatus decodeExtras(const BrickFormat& format, std::span<const std::uint8_t> present,
                          std::span<const std::byte>& in, DecodedBrick& out);

} // namespace tessera::codec
