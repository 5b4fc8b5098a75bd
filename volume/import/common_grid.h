#pragma once

#include "volume/import/assemble.h"

#include <string>
#include <vector>

namespace tessera::volume {

/// The grid on which all samples of `files` lie: that of their grids where they are the same, to 1e-4 of their spacing,
/// else a new one for meshes, of `gridSize` samples (0 = chosen). `notes` get what it does to the samples, or why
/// `gridSize` does not count. `bounds` becomes the box of the data: of meshes their own, which reaches half a cell
/// beyond samples in the middle of cells. Throws Error where a grid that differs cannot be sampled anew.
Lattice chooseLattice(const std::vector<OpenedFile>& files, glm::ivec3 gridSize, Box& bounds,
                      std::vector<std::string>& notes);

} // namespace tessera::volume
