#pragma once

#include "app/importer/readers/source.h"

#include <vtkDataSet.h>

/// Opens a file with the reader for its suffix (app/importer/formats.h).
namespace tessera::importer {

/// A leaf of a composite data set with the name of its block.
struct Block {
    std::string name;
    vtkSmartPointer<vtkDataSet> data; ///< an image has the axes of space
    std::string note;                 ///< about its axes, "" = none
};

/// Chooses a reader and reads the header of a file, or of several that are slices of one volume. Throws
/// std::runtime_error with one line of reason.
Source openSource(const std::vector<std::string>& files);

/// Reads everything at one time and gives the non-empty blocks of the highest dimension.
std::vector<Block> readBlocks(const Source& source, int time);

} // namespace tessera::importer
