#pragma once

#include "codec/brick/brick_levels.h"
#include "codec/brick/decoded_brick.h"
#include "codec/bytes/bytes.h"

#include <span>
#include <vector>

/// Bricks of floats within an error bound whose coefficients are quantised, rather than their samples: samples beyond
/// the bound are corrected. Smooth fields need far fewer bits, since the transform sees no rounding. All arithmetic is
/// that of the integer wavelets, so that the writer knows exactly what a reader gets.
///
/// Corrections as in Li, Lindstrom, Clyne: Lossy scientific data compression with SPERR (2023). (FORMAT.md "Stepped
/// bricks".)
namespace tessera::codec {

struct SteppedBrick {
    std::vector<Bytes> segments;      ///< without absent and exact samples
    std::vector<std::uint32_t> codes; ///< as decoded, storage order; undefined where absent
};

/// Codes a brick such that no code of a present sample changes by more than kReach. `parts`: the part of each sample,
/// or empty; those of a part are transformed by themselves. Only for CC.
SteppedBrick encodeStepped(const BrickFormat& format, std::span<const std::uint32_t> codes,
                           std::span<const std::uint8_t> present, std::span<const std::uint8_t> parts,
                           BrickLevels<std::int32_t>& memory);

Bytes serialise(const StepChoice& steps);
/// Parses steps; the bytes must end with them.
DecodeStatus parseSteps(std::span<const std::byte> bytes, StepChoice& steps);

/// decodeBrick for such bricks.
DecodeStatus decodeStepped(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                           std::span<const std::uint8_t> present, std::span<const std::uint8_t> parts,
                           DecodedBrick& out);

} // namespace tessera::codec
