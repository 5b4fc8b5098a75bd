#pragma once

#include "codec/bytes/octaves.h"
#include "codec/fitted/taps.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Weights of predictions. Samples are predicted by other weights where the samples around them differ more, so that
/// edges, noise and flat parts each have their own. (FORMAT.md "Fitted predictions".)
namespace tessera::codec {

class BitWriter;
class BitReader;

inline constexpr int kWeightBits = 8; ///< weights are in units of 2^-8
/// Classes of activity: half octaves.
inline constexpr int kActivityClasses = 32;
/// Level 0, level 1, and the coarser ones have weights of their own.
inline constexpr int kDepths = 3;

/// The weights of a pass: [pair of taps * kActivityClasses + class], that of the even tap in the low 16 bits; in place
/// of a pair after the last, what is added. Empty: none.
using PassWeights = std::vector<std::int32_t>;

constexpr std::int32_t pairOf(std::int32_t even, std::int32_t odd) {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(even) & 0xffffu) | static_cast<std::uint32_t>(odd)
                                                                                        << 16);
}
constexpr std::int32_t evenOf(std::int32_t pair) {
    return static_cast<std::int16_t>(pair);
}
constexpr std::int32_t oddOf(std::int32_t pair) {
    return pair >> 16;
}

struct FittedWeights {
    std::array<PassWeights, std::size_t(kDepths) * kPasses> passes;

    bool empty() const {
        return std::ranges::all_of(passes, [](const PassWeights& pass) { return pass.empty(); });
    }
    PassWeights& at(int level, Pass pass) { return passes[placeOf(level, pass)]; }
    const PassWeights& at(int level, Pass pass) const { return passes[placeOf(level, pass)]; }
    static std::size_t placeOf(int level, Pass pass) {
        return static_cast<std::size_t>(std::min(level, kDepths - 1) * kPasses) + static_cast<std::size_t>(pass);
    }
    bool operator==(const FittedWeights&) const = default;
};

/// The mean of the first two taps, whatever the activity.
PassWeights plainWeights(Pass pass);

/// Sets the weights of all taps of a class, and what is added, which is the last of `all`.
void setClass(std::span<const std::int32_t> all, std::size_t c, PassWeights& pass);

/// Half octaves of the activity, at most the last class.
inline std::uint32_t activityClass(std::uint32_t activity) {
    return std::min(halfOctaves(activity), std::uint32_t(kActivityClasses - 1));
}

void write(const FittedWeights& weights, BitWriter& out);
/// False: a weight has more than 16 bits, or the bits end too early.
bool read(BitReader& in, FittedWeights& weights);

} // namespace tessera::codec
