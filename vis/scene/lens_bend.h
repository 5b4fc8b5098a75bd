#pragma once

#include "vis/scene/lens.h"

/// Magnifying lenses, for one position or a packet of them. Twin: lensBend in vis/shaders/lib/sampling/lenses.glsl.
namespace tessera::vis {

/// PlacedLens::bend.
template <class N> glm::vec<3, N> bentBy(const PlacedLens& lens, const glm::vec<3, N>& world) {
    const auto times = [](const glm::dmat3& m, const glm::vec<3, N>& v) {
        return spreadOut<N>(m[0]) * v.x + spreadOut<N>(m[1]) * v.y + spreadOut<N>(m[2]) * v.z;
    };
    const N share = lensShare(lens.radius(world), lens.magnification);
    return world - times(lens.fromUnit, times(lens.toUnit, world - spreadOut<N>(lens.center))) * (N(1) - share);
}

/// bend() of all lenses.
template <class N>
glm::vec<3, N> bentBy(std::span<const PlacedLens> lenses, const glm::vec<3, N>& world, const glm::dvec3& halfSize) {
    glm::vec<3, N> out = world;
    for (std::size_t i = lenses.size(); i-- > 0;)
        if (lenses[i].magnification > 1) out = bentBy<N>(lenses[i], out);
    for (int axis = 0; axis < 3; ++axis) {
        const N most = larger(N(halfSize[axis]), magnitude(world[axis]));
        out[axis] = clamped(out[axis], -most, most);
    }
    return out;
}

} // namespace tessera::vis
