#pragma once

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

    bool operator==(const BrickFormat&) const = default;
};

/// Storage samples of the brick at a level.
glm::ivec3 samplesAt(const BrickFormat& format, int level);
/// Every 2^level-th flag of each sublattice: what is present at a level. Empty in, empty out.
std::vector<std::uint8_t> maskAt(const BrickFormat& format, std::span<const std::uint8_t> present, int level);

/// The coded brick: segment 0 holds the coarsest level, segment i what level `levels - 1 - i` adds. `samples` are
/// numbers of format.type, x fastest; `present` one flag each, or empty: all. Quantised numbers off by more than
/// `maxError` are stored exactly. Same input, same bytes.
std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor);

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
                         std::span<const std::uint8_t> present, DecodedBrick& out);

} // namespace tessera::codec
