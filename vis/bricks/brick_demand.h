#pragma once

#include <cstdint>
#include <vector>

namespace tessera::vis {

/// Bricks of a channel that one picture needs: for each brick of full resolution, x fastest, the wanted level and its
/// urgency (smaller: sooner).
struct BrickDemand {
    static constexpr std::uint8_t kNotWanted = 255; ///< out of sight, transparent or hidden
    std::vector<std::uint8_t> level;
    std::vector<float> priority;
    std::vector<std::uint8_t> hidden; ///< 1: behind what is opaque; its level is what is wanted all the same
    bool operator==(const BrickDemand&) const = default;
};

} // namespace tessera::vis
