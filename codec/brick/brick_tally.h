#pragma once

#include "codec/bytes/bits.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/scalar.h"

#include <cstdint>
#include <span>
#include <vector>

/// What an archive notes of the values of a brick: range, mean and histogram. (FORMAT.md "Statistics".)
namespace tessera::codec {

/// Of the values of a brick that are present and finite, at full resolution, as a reader decodes them.
struct BrickTally {
    std::uint32_t samples = 0;         ///< how many there are
    std::uint32_t infinite = 0;        ///< that are present beside them
    std::uint32_t mean = 0;            ///< where it lies between the least and the largest, in kMeanParts parts
    std::vector<std::uint32_t> counts; ///< in equal bins from the least to the largest; empty where there is one bin

    bool operator==(const BrickTally&) const = default;
};

inline constexpr std::uint32_t kMeanParts = (1u << 24) - 1;

/// Bins of a histogram of so many samples, a power of two up to 32: about an eighth of the root of their number.
int binsOf(std::uint32_t samples);

/// Whether a brick of that range has a mean and a histogram: one of a single value, or of none, says it all by that.
bool hasSpread(float min, float max);

struct TalliedBrick {
    float min = 0, max = -1; ///< physical values; min > max: no sample counts
    BrickTally tally;
};

/// Tallies the stored numbers of a brick, whose physical values are offset + scale * number. `present`: one flag each,
/// or empty: all. `withTally` false: the range alone.
TalliedBrick tallied(volume::ScalarType type, double offset, double scale, std::span<const std::byte> samples,
                     std::span<const std::uint8_t> present, bool withTally);

/// Whether a brick is as it is noted to be; of the mean the last digits may differ.
bool agree(const TalliedBrick& brick, float min, float max, const BrickTally& noted);

/// Writes the tally of a brick of that range; `isFloat`: samples may be present and not finite.
void put(BitWriter& out, float min, float max, bool isFloat, const BrickTally& tally);
/// Reads it back. `present`: samples of the brick that are. False where the bits are not those of a tally, or end.
bool take(BitReader& in, float min, float max, bool isFloat, std::uint32_t present, BrickTally& tally);

/// As a source gives it; nothing where the range is not finite. `step`: between stored numbers, 0 for floats.
std::optional<volume::BrickDistribution> distributionOf(float min, float max, double step, const BrickTally& tally);

} // namespace tessera::codec
