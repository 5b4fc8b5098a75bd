#include "volume/field/lattice4.h"

#include <cmath>
#include <glm/common.hpp>

namespace tessera::volume {

Lattice Lattice4::grid(int frame) const {
    const double half = kind == LatticeKind4::D4 && frame % 2 != 0 ? 0.5 : 0.0;
    const glm::dvec3 cell(spacing);
    return {LatticeKind::CC, glm::ivec3(size), cell, glm::dvec3(origin) + half * cell, axes};
}

Lattice Lattice4::atOneTime() const {
    Lattice lattice = grid(0);
    if (kind == LatticeKind4::CC) return lattice;
    lattice.kind = LatticeKind::BCC;
    lattice.size.z *= 2;
    return lattice;
}

int Lattice4::framesOf(int parity) const {
    if (kind == LatticeKind4::CC) return parity == 0 ? size.w : 0;
    return (size.w + 1 - parity) / 2;
}

Lattice4 d4For(const Lattice4& cc) {
    Lattice4 d4;
    d4.kind = LatticeKind4::D4;
    d4.axes = cc.axes;
    d4.spacing = cc.spacing * kBccSpacing;
    glm::dvec4 span{0}; // in space, from the first to the last sample, in cells
    for (int axis = 0; axis < 3; ++axis) {
        d4.size[axis] = std::max(int(cc.size[axis] / kBccSpacing), 1);
        span[axis] = d4.size[axis] - 0.5;
    }
    d4.size.w = int(std::ceil(kBccSpacing * (cc.size.w - 1))) + 3;
    d4.origin = cc.origin + 0.5 * (cc.spacing * glm::dvec4(cc.size - 1) - d4.spacing * span);
    d4.origin.w = cc.origin.w - 0.5 * d4.spacing.w;
    return d4;
}

} // namespace tessera::volume
