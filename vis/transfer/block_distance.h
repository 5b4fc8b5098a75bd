#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

/// Which blocks of a volume show nothing, and how far the next one is that does.
namespace tessera::vis {

/// Chebyshev distance of every block to the nearest one with distance 0, in place (x fastest; at most 255). Blocks that
/// are not 0 must be 255.
void spreadDistance(std::vector<std::uint8_t>& distance, glm::ivec3 count);

/// Answers whether a curve has opacity anywhere in an interval of samples.
class OpacityRanges {
public:
    /// `opacity`: of evenly spaced places 0..1; `map`: from samples to places, factor and summand.
    OpacityRanges(const std::vector<float>& opacity, glm::dvec2 map);
    bool any(float lo, float hi) const;

private:
    glm::dvec2 map_;
    std::vector<int> before_; ///< entry i: number of entries before i with opacity
};

} // namespace tessera::vis
