#pragma once

#include "volume/import/file_groups.h"

#include <string>
#include <vector>

namespace tessera::volume {

/// The grid for all samples of `files`: their common grid if they agree to 1e-4 of its spacing, else a new one for
/// meshes, of `gridSize` samples (0 = automatic). `notes` receives what this does to the samples, or why `gridSize` is
/// ignored. `bounds` becomes the box of the data: for meshes their own, which extends half a cell beyond samples at
/// cell centres. Throws Error where a different grid cannot be resampled.
Lattice chooseLattice(const std::vector<OpenedFile>& files, glm::ivec3 gridSize, Box& bounds,
                      std::vector<std::string>& notes);

} // namespace tessera::volume
