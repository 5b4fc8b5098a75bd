#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/import_options.h"

#include <string>
#include <vector>

/// Import of foreign files as a Dataset on a CC grid: raw files with a JSON sidecar here, everything else through the
/// second program `tessera-import` (VTK's readers), which streams frames over a pipe.
namespace tessera::volume {

/// Contents of files as far as their headers tell, without reading samples.
struct ImportPreview {
    std::string format;             ///< "raw", "vti", "OpenFOAM", ...
    DatasetInfo info;               ///< ranges empty; for a mesh the grid it would be resampled to
    double bytes = 0;               ///< of all samples when read
    std::vector<std::string> notes; ///< e.g. "unstructured mesh of 41 000 cells, resampled to 24 x 32 x 88"
};

/// Keeps only the parameters of these names, all if there is none, and the labels of their parts. Throws Error for
/// names that there are not.
Dataset withParameters(Dataset dataset, const std::vector<std::string>& wanted);

/// Bytes of all samples of a data set.
double bytesOf(const DatasetInfo& info);

/// Previews files that belong together (several parameters, a series: see volume/import/files/series.h), and whether
/// the options fit them. Throws Error.
ImportPreview previewFiles(const std::vector<std::string>& paths, const ImportOptions& options,
                           const Progress& progress = {}, Misfits misfits = Misfits::Refused);

/// Opens the files; frames are read on demand, in parts where the files allow it: raw files, and NRRD files without
/// compression. `meshRanges`: Parameter::ranges of meshes are those of their own values at points or cells, for which
/// every file is read; else unknown, as those of grids are. Units of parameters that are not there are ignored:
/// sessions may hold those of other data. Throws Error.
Dataset openFiles(const std::vector<std::string>& paths, const ImportOptions& options, const Progress& progress = {},
                  bool meshRanges = true);

/// Fills in Parameter::ranges (present samples, all times) by reading every frame once. Throws Error, Cancelled.
void scanRanges(Dataset& dataset, const Progress& progress = {});

} // namespace tessera::volume
