#pragma once

#include "volume/import/files/piece.h"
#include "volume/import/files/series.h"
#include "volume/import/import.h"

#include <vector>

namespace tessera::volume {

/// A file of a series and the blocks a reader found in it.
struct OpenedFile {
    SeriesFile entry;
    std::vector<Piece> pieces;
};

/// Files put together.
struct Assembled {
    Dataset dataset;  ///< with the file's own array names
    SliceLoad slices; ///< of its frames; null where one of the files can only be read whole
    std::vector<std::string> notes;
    bool mesh = false; ///< samples are found in cells, which costs time
    /// Ranges of a parameter of meshes over all times, from the values at points or cells; empty where not known. Reads
    /// every file.
    std::function<std::vector<Range>(int parameter, const Progress& progress)> ranges;
    bool madeLabel = false; ///< the last parameter is a label made from blocks
};

/// Puts files together into one data set: files of a group follow each other in time, arrays of equal name from several
/// meshes are merged onto one grid (the first that has a sample wins), several files on one grid add parameters. A
/// `region` label is made from the names of mesh blocks where there is no label. Where files store an array in
/// different types, all its frames get one that holds their numbers (commonType). `gridSize` (0 = chosen) is for
/// meshes. Throws Error when things do not fit. Without `readSamples` no sample is read (the values of a made label are
/// then not yet known).
Assembled assemble(std::vector<OpenedFile> files, glm::ivec3 gridSize, bool readSamples, const Progress& progress);

} // namespace tessera::volume
