#pragma once

#include "codec/bytes/bits.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/scalar.h"

#include <cstdint>
#include <span>
#include <vector>

/// Statistics of a brick stored in an archive: range, mean and histogram. (FORMAT.md "Statistics".)
namespace tessera::codec {

/// Mean and histogram of the present, finite values of a brick at full resolution, as decoded.
struct BrickHistogram {
    std::uint32_t samples = 0;         ///< number of present and finite samples
    std::uint32_t infinite = 0;        ///< number of present samples that are not finite
    std::uint32_t mean = 0;            ///< position between minimum and maximum, in units of 1/kMeanParts
    std::vector<std::uint32_t> counts; ///< in equal bins from minimum to maximum; empty if there is one bin

    bool operator==(const BrickHistogram&) const = default;
};

inline constexpr std::uint32_t kMeanParts = (1u << 24) - 1;

/// Number of histogram bins for a number of samples: a power of two up to 32, about an eighth of its square root.
int binsOf(std::uint32_t samples);

/// Whether a brick with this range has a mean and a histogram; a constant or empty brick needs neither.
bool hasSpread(float min, float max);

struct BrickSummary {
    float min = 0, max = -1; ///< physical values; min > max: no present, finite sample
    BrickHistogram histogram;
};

/// Computes the statistics of a brick from stored numbers, whose physical values are offset + scale * number.
/// `present`: one flag each, or empty: all present. Without `withHistogram`: only the range.
BrickSummary summaryOf(volume::ScalarType type, double offset, double scale, std::span<const std::byte> samples,
                       std::span<const std::uint8_t> present, bool withHistogram);

/// Whether the statistics of a brick equal stored ones, up to rounding of the mean.
bool agree(const BrickSummary& brick, float min, float max, const BrickHistogram& noted);

/// Writes the statistics of a brick with this range. `isFloat`: samples can be present but not finite.
void put(BitWriter& out, float min, float max, bool isFloat, const BrickHistogram& histogram);
/// Reads the statistics written by put. `present`: number of present samples. False if the bits are invalid or end
/// early.
bool take(BitReader& in, float min, float max, bool isFloat, std::uint32_t present, BrickHistogram& histogram);

/// Converts the statistics for volume::BrickSource; empty if the range is not finite. `step`: distance between stored
/// numbers, 0 for floats.
std::optional<volume::BrickDistribution> distributionOf(float min, float max, double step,
                                                        const BrickHistogram& histogram);

} // namespace tessera::codec
