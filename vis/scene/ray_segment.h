#pragma once

#include <glm/vec3.hpp>

namespace tessera::vis {

/// An interval of a ray, as distances from its origin.
struct RaySegment {
    double enter = 0, exit = 0;
};

/// The same, and a ray, of one number or a packet of them (volume/base/numbers.h). Directions have length 1.
template <class N> struct SegmentOf { N enter, exit; };
template <class N> struct RayOf { glm::vec<3, N> origin, direction; };

} // namespace tessera::vis
