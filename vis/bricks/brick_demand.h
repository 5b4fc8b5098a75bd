#pragma once

#include <cstdint>
#include <vector>

namespace tessera::vis {

/// The bricks of a channel that one picture needs: for each brick at full resolution, x fastest, the wanted level and
/// the priority (smaller is more urgent).
struct BrickDemand {
    static constexpr std::uint8_t kNotWanted = 255; ///< outside the view, transparent or occluded
    std::vector<std::uint8_t> level;
    std::vector<float> priority;
    std::vector<std::uint8_t> hidden; ///< 1: occluded by something opaque; `level` is still the level wanted
    bool operator==(const BrickDemand&) const = default;
};

} // namespace tessera::vis
