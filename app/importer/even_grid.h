#pragma once

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// A structured or rectilinear grid along the axes with even steps (to 0.1 % of a step) as an image, so that its
/// samples stay as they are; anything else as it is.
vtkSmartPointer<vtkDataSet> asEvenGrid(vtkSmartPointer<vtkDataSet> data);

} // namespace tessera::importer
