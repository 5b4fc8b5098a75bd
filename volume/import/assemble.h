#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/file_groups.h"
#include "volume/import/import_options.h"

#include <functional>
#include <string>
#include <vector>

namespace tessera::volume {

/// A data set assembled from files.
struct Assembled {
    Dataset dataset; ///< with the file's own array names; read in parts where all files can be
    std::vector<std::string> notes;
    bool mesh = false; ///< samples are found in cells, which costs time
    /// Ranges of a parameter of meshes over all times, from the values at points or cells; empty where not known. Reads
    /// every file.
    std::function<std::vector<Range>(int parameter, const Progress& progress)> ranges;
    bool madeLabel = false; ///< the last parameter is a label made from blocks
};

/// Assembles files into one data set: files of a group are consecutive times, arrays of equal name from several meshes
/// are merged onto one grid (the first that has a sample is used), several files on one grid add parameters. If there
/// is no label, `region` is created from the names of mesh blocks. If files store an array in different types, all its
/// frames get one type that holds their numbers (commonType). `options` say on which grid meshes are sampled. Without
/// `readSamples` no sample is read, but for a created label of few samples (the values of others are not yet known).
/// Throws Error when the files do not fit together.
Assembled assemble(std::vector<OpenedFile> files, const ImportOptions& options, bool readSamples,
                   const Progress& progress);

} // namespace tessera::volume
