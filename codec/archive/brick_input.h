#pragma once

#include "codec/brick/brick_codec.h"
#include "codec/container/index.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/field.h"

/// The samples of a brick before coding, and as decoded later.
namespace tessera::codec {

/// The samples of one brick as encodeBrick wants them.
struct BrickInput {
    Bytes samples;
    std::vector<std::uint8_t> present; ///< empty: all

    void take(const volume::BrickGrid& grid, glm::ivec3 brick, const FrameSamples& frame, bool masked);
    /// Copies any box of the lattice.
    void take(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const FrameSamples& frame, bool masked);
};

/// Writes the samples of a brick into a field.
void putSamples(const volume::BrickGrid& grid, glm::ivec3 brick, std::span<const std::byte> samples,
                volume::Field& field);

/// Replaces samples by their decoded values: for floats with an error bound, the values of their codes.
void roundAsDecoded(const BrickFormat& format, double maxError, BrickInput& input);

/// Range of the decoded samples, as physical values, and their statistics if `withTally` is set.
FrameBrick tallyOf(const volume::Field& field, const BrickInput& decoded, bool withTally);

/// The latest frame of a component, as decoded: the next frame may repeat its bricks, and its change is measured from
/// it.
struct SeenFrame {
    int time = -1;
    bool keepsAbsent = false;
    volume::Field field;
    std::vector<FrameBrick> bricks;
    std::vector<std::uint64_t> bytes; ///< that each brick takes, of repeats those of the first
};

/// True if `decoded`, a brick of an earlier frame as decoded, may replace `input`: the same samples are present, and
/// all are equal bit by bit, or, for floats, at most `maxError` apart; `absentToo`: absent samples must be equal as
/// well.
bool mayStandFor(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input, double maxError,
                 bool absentToo);
/// Sum of squared differences of present samples, as stored; samples that are not finite are skipped.
double squaredError(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input);

} // namespace tessera::codec
