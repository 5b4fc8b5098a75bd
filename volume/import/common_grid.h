#pragma once

#include "volume/import/file_groups.h"
#include "volume/import/import_options.h"

#include <string>
#include <vector>

namespace tessera::volume {

/// A grid for all samples of a data set.
struct ChosenGrid {
    Lattice lattice;
    bool aligned = false;    ///< samples lie between planes where all cells begin and end
    bool onePerCell = false; ///< of a mesh of boxes with values of cells: each has one sample, in its middle
};
/// The grid for all samples of `files`: their common grid if they agree to 1e-4 of its spacing, else a new one for
/// meshes: even and of `options.gridSize` samples, or as `options.grid` says. `notes` receives what this does to the
/// samples, or why `gridSize` is ignored. `bounds` becomes the box of the data: for meshes their own, which extends
/// half a cell beyond samples at cell centres. Throws Error where a different grid cannot be resampled.
ChosenGrid chooseGrid(const std::vector<OpenedFile>& files, const ImportOptions& options, Box& bounds,
                      std::vector<std::string>& notes);

} // namespace tessera::volume
