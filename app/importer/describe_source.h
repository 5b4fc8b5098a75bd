#pragma once

#include "app/importer/open_source.h"
#include "volume/import/files/piece.h"

#include <vector>
#include <vtkDataArray.h>

namespace tessera::importer {

/// One array as the main program sees it: a scalar or vector array of VTK, or one component of an odd one.
struct ArrayRef {
    volume::Array form;
    bool ofCells = false;
    std::string vtkName;
    int firstComponent = 0;
};

/// A piece and how its arrays are found in VTK's data.
struct PieceRef {
    volume::Piece piece;
    std::vector<ArrayRef> arrays;
    double scale = 1, offset = 0; ///< NIfTI's slope: physical = offset + scale * stored
};

/// What the header of an image says, without reading samples; empty where the reader cannot tell.
std::vector<PieceRef> describeImageHeader(Source& source);

/// What the blocks say once read.
std::vector<PieceRef> describeBlocks(const Source& source, const std::vector<Block>& blocks);

/// What the field data of one time say: numbers (a voltage) become quantities, and words the units, the labels and the
/// name and unit of the times.
void describeFieldData(vtkFieldData* data, volume::Piece& piece, std::vector<ArrayRef>& arrays);

/// The field data of an unstructured grid, read without its points and cells.
vtkSmartPointer<vtkFieldData> fieldDataAlone(const std::string& path);

/// The array in a block; null when it is not there.
vtkDataArray* findArray(vtkDataSet* data, const ArrayRef& array);

/// The JSON text that answers a question for the ranges of an array (volume/import/files/stream.h).
std::string rangesJson(vtkDataSet* data, vtkDataArray* values, const ArrayRef& array);

/// The JSON text of the header message of one or more pieces (volume/import/files/stream.h).
std::string headerJson(const std::vector<PieceRef>& pieces);

} // namespace tessera::importer
