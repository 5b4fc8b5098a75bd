#pragma once

#include "codec/brick/brick_codec.h"
#include "codec/brick/frame_samples.h"
#include "codec/container/index.h"
#include "volume/bricks/brick_grid.h"
#include "volume/field/dataset.h"
#include "volume/field/field.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// The samples of a brick as input of the encoder, and as they will be decoded.
namespace tessera::codec {

/// The samples of one brick in the layout of encodeBrick.
struct BrickInput {
    Bytes samples;
    std::vector<std::uint8_t> present; ///< empty: all
    std::vector<std::uint8_t> parts;   ///< part of each sample, if it was taken

    void take(const volume::BrickGrid& grid, glm::ivec3 brick, const FrameSamples& frame, bool masked);
    /// Copies a box of the lattice.
    void take(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const FrameSamples& frame, bool masked);
    /// Takes the parts of a box from a frame of their numbers, of 8 bits.
    void takeParts(const volume::BrickGrid& grid, glm::ivec3 begin, glm::ivec3 size, const FrameSamples& frame);
};

/// Writes the samples of a brick into a field.
void putSamples(const volume::BrickGrid& grid, glm::ivec3 brick, std::span<const std::byte> samples,
                volume::Field& field);

/// Replaces samples by the values they decode to: with an error bound, the values of their codes, or of `decoded` if
/// coefficients are quantised.
void roundAsDecoded(const BrickFormat& format, double maxError, std::span<const std::uint32_t> decoded,
                    BrickInput& input);

/// Range of the decoded samples in physical values; also their statistics if `withHistogram`.
FrameBrick statisticsOf(const volume::Field& field, const BrickInput& decoded, bool withHistogram);

/// The latest frame of a component as decoded: the next frame may repeat its bricks, and its change is measured against
/// it.
struct SeenFrame {
    int time = -1;
    bool keepsAbsent = false;
    std::int32_t mask = -1;
    volume::Field field;
    std::vector<FrameBrick> bricks;
    std::vector<std::uint64_t> bytes; ///< per brick; for a repeat those of the brick it repeats
    std::vector<std::uint8_t> depth;  ///< the same: how many bricks it is predicted from, one from the other
};

/// Whether `decoded`, a brick of an earlier frame, can replace `input`: the same samples are present, and all are
/// bitwise equal or differ by at most `maxError`. `absentToo`: absent samples must be equal as well.
bool mayStandFor(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input, double maxError,
                 bool absentToo);
/// Differences of samples, in stored units.
struct SampleErrors {
    double squares = 0; ///< sum
    double largest = 0;
};
/// Of present samples, without those that are not finite.
SampleErrors errorsOf(volume::ScalarType type, const BrickInput& decoded, const BrickInput& input);

} // namespace tessera::codec
