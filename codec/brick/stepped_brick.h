#pragma once

#include "codec/brick/brick_levels.h"
#include "codec/brick/decoded_brick.h"
#include "codec/bytes/bytes.h"
#include "codec/wavelet/subbands.h"

#include <span>
#include <vector>

/// Bricks of floats within an error bound whose coefficients are quantised, rather than their samples: samples beyond
/// the bound are corrected. Smooth fields need far fewer bits, since the transform sees no rounding. All arithmetic is
/// that of the integer wavelets, so that the writer knows exactly what a reader gets.
///
/// Corrections as in Li, Lindstrom, Clyne: Lossy scientific data compression with SPERR (2023). (FORMAT.md "Stepped
/// bricks".)
namespace tessera::codec {

/// How coefficients of a brick are quantised, for numbers of kind Stepped.
struct StepChoice {
    DetailSplit split;
    std::uint32_t quantum = 0; ///< of coefficients whose waveforms have length 1, in 1/16 of a code
};

struct SteppedBrick {
    std::vector<Bytes> segments;      ///< without absent and exact samples
    std::vector<std::uint32_t> codes; ///< as decoded, storage order; undefined where absent
};

/// Codes a brick such that no code of a present sample changes by more than kReach.
SteppedBrick encodeStepped(const BrickFormat& format, std::span<const std::uint32_t> codes,
                           std::span<const std::uint8_t> present, const StepChoice& steps,
                           BrickLevels<std::int32_t>& memory);

/// Takes the steps from the front of segment 0, behind what it may have "first" (FORMAT.md 4.1).
DecodeStatus takeSteps(std::span<const std::byte>& in, StepChoice& steps);

/// decodeBrick for such bricks.
DecodeStatus decodeStepped(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                           std::span<const std::uint8_t> present, DecodedBrick& out);

} // namespace tessera::codec
