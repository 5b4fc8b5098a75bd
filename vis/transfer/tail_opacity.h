#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

/// Opacity curves from a histogram alone, for fields without material boundaries: what is rare is shown, what is
/// everywhere is clear.
namespace tessera::vis {

/// Opacity from which a value counts as seen in seenShare().
inline constexpr double kSeenOpacity = 0.1;

/// Share of `places` (samples, absent ones too) whose value has an opacity of at least kSeenOpacity. Bin b of `count`
/// covers [b, b + 1] / count.size() of the range, as the places of the curve do.
double seenShare(std::span<const std::uint64_t> count, std::uint64_t places, std::span<const glm::vec2> opacity);

/// The curve that shows the tails of a histogram: 0 where the bulk of the values lies (the shortest interval that holds
/// half of them), rising from the quantile beyond which `share` of all values lie to 0.8 at the end of the range. A
/// tail less than half as long as the other one stays clear. Where there is no tail, the straight line from 0 to 0.8.
std::vector<glm::vec2> tailOpacity(std::span<const std::uint64_t> count, double share);

/// The same for values whose sign matters, over a range that is even about 0: both signs rise from the magnitude beyond
/// which `share` of the values lie.
std::vector<glm::vec2> signedTailOpacity(std::span<const std::uint64_t> count, double share);

} // namespace tessera::vis
