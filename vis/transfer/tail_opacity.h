#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

/// Opacity curves from a histogram only, for fields without material boundaries: rare values are opaque, common ones
/// transparent.
namespace tessera::vis {

/// Opacity from which on a value counts as visible in seenShare().
inline constexpr double kSeenOpacity = 0.1;

/// Fraction of `places` (number of samples, including absent ones) whose value has an opacity of at least kSeenOpacity.
/// Bin b of `count` covers [b, b + 1] / count.size() of the range, like the positions of the curve.
double seenShare(std::span<const std::uint64_t> count, std::uint64_t places, std::span<const glm::vec2> opacity);

/// The curve that shows the tails of a histogram: 0 in the bulk of the values (the shortest interval that holds half of
/// them), rising from the quantile beyond which `share` of all values lie to 0.8 at the end of the range. A tail less
/// than half as long as the other one stays transparent. Of values spread nearly evenly, without a bulk, the lower half
/// stays transparent, as dark colours are hard to see. Without tails, a straight line from 0 to 0.8.
std::vector<glm::vec2> tailOpacity(std::span<const std::uint64_t> count, double share);

/// Makes a curve of tailOpacity() steeper at its start, where it rises so slowly that less than `least` of the places
/// are seen: from the quantile on beyond which so many lie, but not in the bulk, which stays clear.
void seeAtLeast(std::vector<glm::vec2>& curve, std::span<const std::uint64_t> count, std::uint64_t places,
                double least);

/// tailOpacity() for signed values over a range symmetric about 0: rises on both sides from the magnitude beyond which
/// `share` of the values lie.
std::vector<glm::vec2> signedTailOpacity(std::span<const std::uint64_t> count, double share);

} // namespace tessera::vis
