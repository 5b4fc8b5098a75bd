#pragma once

#include "volume/field/slices.h"
#include "volume/import/import.h"

namespace tessera::volume {

/// A data set whose frames can also be read in parts, where the files allow it.
struct SlicedDataset {
    Dataset dataset;
    SliceLoad slices; ///< null: whole frames only
};

/// openFiles() with slices: of raw files and NRRD files without compression.
SlicedDataset openSliced(const std::vector<std::string>& paths, const ImportOptions& options,
                         const Progress& progress = {});

} // namespace tessera::volume
