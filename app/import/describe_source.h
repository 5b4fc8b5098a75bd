#pragma once

#include "app/import/source.h"
#include "volume/import/piece.h"

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

/// The array in a block; null when it is not there.
vtkDataArray* findArray(vtkDataSet* data, const ArrayRef& array);

/// The JSON text of the header message of one or more pieces (volume/import/stream.h).
std::string headerJson(const std::vector<PieceRef>& pieces);

} // namespace tessera::importer
