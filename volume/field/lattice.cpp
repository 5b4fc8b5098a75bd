#include "volume/field/lattice.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::volume {

glm::dvec3 Lattice::sheetPosition(glm::ivec3 at) const {
    if (kind == LatticeKind::CC) return origin + spacing * glm::dvec3(at);
    const double half = at.z % 2 != 0 ? 0.5 : 0.0;
    return origin + spacing * glm::dvec3(at.x + half, at.y + half, at.z * 0.5);
}

glm::dvec3 Lattice::between(glm::dvec3 place) const {
    glm::dvec3 cells = toCells(place);
    if (kind != LatticeKind::CC) return cells;
    for (int axis = 0; axis < 3; ++axis)
        if (const AxisMap* map = axes[axis]) {
            if (spacing[axis] == map->spacing()) {
                const double index = map->between(place[axis]);
                cells[axis] = (map->origin() + index * map->spacing() - origin[axis]) / spacing[axis];
                continue;
            }
            // A coarser level: the two of its samples around the place.
            const double base = std::floor(cells[axis]);
            const double a = map->toSpace(origin[axis] + base * spacing[axis]),
                         b = map->toSpace(origin[axis] + (base + 1) * spacing[axis]);
            cells[axis] = base + (place[axis] - a) / (b - a);
        }
    return cells;
}

glm::dvec3 Lattice::lengthsAt(glm::dvec3 place) const {
    if (isEven()) return glm::abs(spacing);
    const glm::dvec3 sheet = axes.toSheet(place), half = 0.5 * glm::abs(spacing);
    return axes.toSpace(sheet + half) - axes.toSpace(sheet - half);
}

glm::ivec3 Lattice::nearestToCells(glm::dvec3 cells) const {
    const glm::ivec3 last = size - 1;
    if (kind == LatticeKind::CC) return glm::clamp(glm::ivec3(glm::floor(cells + 0.5)), glm::ivec3(0), last);
    glm::ivec3 best(0);
    double bestDistance = 0;
    for (int sublattice = 0; sublattice < (size.z > 1 ? 2 : 1); ++sublattice) {
        const double half = sublattice * 0.5;
        const glm::ivec3 at =
            glm::clamp(glm::ivec3(glm::floor(cells - half + 0.5)), glm::ivec3(0), sublatticeSize(sublattice) - 1);
        const glm::dvec3 apart = glm::dvec3(at) + half - cells;
        const double distance = glm::dot(apart, apart);
        if (sublattice == 0 || distance < bestDistance) {
            bestDistance = distance;
            best = {at.x, at.y, 2 * at.z + sublattice};
        }
    }
    return best;
}

glm::ivec3 Lattice::texels() const {
    return kind == LatticeKind::CC ? size : sublatticeSize(0);
}

glm::ivec3 Lattice::sublatticeSize(int sublattice) const {
    if (kind == LatticeKind::CC) return size;
    return {size.x, size.y, (size.z + 1 - sublattice) / 2};
}

Lattice withAxes(Lattice even, AxisMaps axes) {
    even.axes = std::move(axes);
    for (int axis = 0; axis < 3; ++axis)
        if (const AxisMap* map = even.axes[axis]) {
            even.size[axis] = map->samples();
            even.spacing[axis] = map->spacing();
            even.origin[axis] = map->origin();
        }
    return even;
}

Lattice bccFor(const Lattice& cc) {
    Lattice bcc;
    bcc.kind = LatticeKind::BCC;
    const glm::dvec3 size(cc.size);
    bcc.size = glm::max(glm::ivec3(glm::round(size / glm::dvec3(kBccSpacing, kBccSpacing, kBccSpacing / 2))),
                        glm::ivec3(1, 1, 2));
    bcc.axes = cc.axes;
    bcc.spacing = cc.spacing * kBccSpacing;
    const glm::dvec3 span(bcc.size.x - 0.5, bcc.size.y - 0.5, (bcc.size.z - 1) * 0.5);
    const glm::dvec3 excess = span * kBccSpacing - (size - 1.0);
    bcc.origin = cc.origin - excess * 0.5 * cc.spacing;
    return bcc;
}

} // namespace tessera::volume
