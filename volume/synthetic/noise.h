#pragma once

#include <glm/vec3.hpp>

namespace tessera::volume {

/// Noise in -1..1 of a sample by its index, evenly distributed, the same always and everywhere.
inline double noiseAt(glm::ivec3 at) {
    unsigned h = unsigned(at.x) * 73856093u ^ unsigned(at.y) * 19349663u ^ unsigned(at.z) * 83492791u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return double((h ^ (h >> 16)) & 0xffff) / 32767.5 - 1;
}

} // namespace tessera::volume
