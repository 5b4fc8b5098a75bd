#pragma once

#include "codec/brick/brick_codec.h"
#include "codec/container/index.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/field.h"

/// The samples of a brick on their way into an archive, and as a reader will see them.
namespace tessera::codec {

/// The samples of one brick as encodeBrick wants them.
struct BrickInput {
    Bytes samples;
    std::vector<std::uint8_t> present; ///< empty: all

    void take(const volume::BrickGrid& grid, glm::ivec3 brick, const FrameSamples& frame, bool masked);
    /// Any box of the lattice.
    void take(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const FrameSamples& frame, bool masked);
};

/// Writes the samples of a brick into a field.
void putSamples(const volume::BrickGrid& grid, glm::ivec3 brick, std::span<const std::byte> samples,
                volume::Field& field);

/// Turns samples into what a reader will decode: of floats within a bound those of their codes.
void roundAsDecoded(const BrickFormat& format, double maxError, BrickInput& input);

/// Range of the samples a reader will decode, as physical values, and their tally if it is wanted.
FrameBrick tallyOf(const volume::Field& field, const BrickInput& decoded, bool withTally);

/// The latest frame of a component as a reader sees it: what the next one may repeat, and what its change is counted
/// from.
struct SeenFrame {
    int time = -1;
    bool keepsAbsent = false;
    volume::Field field;
    std::vector<FrameBrick> bricks;
    std::vector<std::uint64_t> bytes; ///< that each brick takes, of repeats those of the first
};

/// True if `decoded`, which a reader sees of an earlier frame, may stand for `input`: the same samples present, all of
/// them equal bit by bit, or of floats at most `maxError` apart; `absentToo`: those absent equal as well.
bool mayStandFor(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input, double maxError,
                 bool absentToo);
/// Sum of the squares of the differences of present samples, as stored; those that are not finite do not count.
double squaredError(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input);

} // namespace tessera::codec
