#pragma once

#include "app/importer/open_source.h"
#include "volume/import/files/file_block.h"

#include <vector>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// One array as described to the main program: a scalar or vector array of VTK, or one component of an array with
/// another number of components.
struct ArrayRef {
    volume::Array form;
    bool ofCells = false;
    std::string vtkName;
    int firstComponent = 0;
    StoredForm stored = {};
};

/// A block and how its arrays are found in VTK's data.
struct BlockRef {
    volume::FileBlock block;
    std::vector<ArrayRef> arrays;
};

/// Describes an image from its header, without reading samples; empty if the header does not suffice.
std::vector<BlockRef> describeImageHeader(Source& source);

/// Describes blocks that have been read.
std::vector<BlockRef> describeBlocks(const Source& source, const std::vector<Block>& blocks);

/// Whether an array of this name says something of points and cells, and is no parameter (vtkGhostType).
bool isVtkHelper(const std::string& name);

/// Takes over the field data of one time: numbers (a voltage) become quantities; texts state units, labels, and the
/// name and unit of the times.
void describeFieldData(vtkFieldData* data, volume::FileBlock& block, std::vector<ArrayRef>& arrays);

/// The field data of an unstructured grid, read without its points and cells.
vtkSmartPointer<vtkFieldData> fieldDataAlone(const std::string& path);

/// Adds what another time, or file, of the same data shows: blocks (by name), their arrays, and the box of all.
void mergeBlocks(std::vector<BlockRef>& blocks, const std::vector<BlockRef>& more);

/// What the header of a file of VTK's unstructured grids says of its mesh and arrays: equal where all but the values
/// are. "" for other files, and where the header does not tell.
std::string meshHead(const Source& source);

/// The array in a block; null if it is missing.
vtkDataArray* findArray(vtkDataSet* data, const ArrayRef& array);

/// The JSON answer to a "ranges" request (volume/import/files/stream.h); no array (null) has no range.
std::string rangesJson(vtkDataSet* data, vtkDataArray* values, const ArrayRef& array, bool between);

/// The JSON of a header message (volume/import/files/stream.h).
std::string headerJson(const std::vector<BlockRef>& blocks);

} // namespace tessera::importer
