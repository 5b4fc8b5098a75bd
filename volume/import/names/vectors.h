#pragma once

#include "volume/field/dataset.h"

#include <array>
#include <set>
#include <string>
#include <vector>

/// Vectors that files store as one scalar for each component.
namespace tessera::volume {

/// Scalars whose names say that they are the components of one vector.
struct NamedVector {
    std::string name;
    std::array<int, 3> components{-1, -1, -1}; ///< parameters along x, y, z; the third -1 in a plane: it is 0
};

/// The vectors among the scalars of a data set: u v w; Ux Uy Uz; X_VELOCITY, "x-velocity", vel_x, "Velocity[i]", U:0,
/// "Velocity field, x component" and their siblings. All three are there (on one layer of samples two do), with the
/// same unit and type, none of them a label or in `kept`; components of tensors (xx, xy) and positions are none. A
/// velocity is named U, others what their components' names share.
std::vector<NamedVector> findVectors(const DatasetInfo& info, const std::set<std::string>& kept = {});

/// The data set with a vector in place of its components, and what became of each parameter.
struct WithVectors {
    Dataset dataset;
    std::vector<std::vector<int>> from; ///< by parameter: those it was before, three (or two) of a vector
    std::vector<std::string> notes;
};
WithVectors withVectors(Dataset dataset, const std::set<std::string>& kept);

} // namespace tessera::volume
