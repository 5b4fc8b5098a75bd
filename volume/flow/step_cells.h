#pragma once

#include "volume/field/lattice.h"

#include <glm/vec3.hpp>

namespace tessera::volume {

/// How near to the end of a field a line comes, cells.
inline constexpr double kShortestStep = 1.0 / 256;

/// The cells in which steps along a field and their errors are measured: of one size, or those of a lattice at each
/// place. With uneven axes no step crosses more than `longestStep` of cells, however short those on its way are.
struct StepCells {
    glm::dvec3 cell{1};
    const Lattice* lattice = nullptr; ///< null: `cell` everywhere
    double longestStep = 0.5;         ///< cells

    /// Edges of a cell for the next step from a place along a direction: of uneven axes the smaller ones of both ends.
    glm::dvec3 at(glm::dvec3 place, glm::dvec3 direction) const;
    /// The most of a direction that a step goes over uneven axes; infinite on even ones.
    double most(glm::dvec3 place, glm::dvec3 direction) const;
};

} // namespace tessera::volume
