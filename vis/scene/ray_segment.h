#pragma once

namespace tessera::vis {

/// An interval of a ray, as distances from its origin.
struct RaySegment {
    double enter = 0, exit = 0;
};

} // namespace tessera::vis
