#pragma once

namespace tessera::vis {

/// Part of a ray, as distances from its origin.
struct RaySegment {
    double enter = 0, exit = 0;
};

} // namespace tessera::vis
