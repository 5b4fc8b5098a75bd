#include "volume/flow/step_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::volume {

glm::dvec3 StepCells::at(glm::dvec3 place, glm::dvec3 direction) const {
    if (!lattice) return cell;
    const glm::dvec3 here = lattice->lengthsAt(place);
    const double cells = glm::length(direction / here);
    if (lattice->isEven() || !(cells > 0)) return here;
    return glm::min(here, lattice->lengthsAt(place + direction * (longestStep / cells)));
}

double StepCells::most(glm::dvec3 place, glm::dvec3 direction) const {
    double most = std::numeric_limits<double>::infinity();
    if (!lattice || lattice->isEven()) return most;
    const glm::dvec3 cells = lattice->toCells(place);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        glm::dvec3 to = cells;
        to[axis] += std::copysign(longestStep, direction[axis] * lattice->spacing[axis]);
        most = std::min(most, std::abs((lattice->fromCells(to)[axis] - place[axis]) / direction[axis]));
    }
    return most;
}

} // namespace tessera::volume
