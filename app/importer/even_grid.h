#pragma once

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// Converts an axis-aligned structured or rectilinear grid with even steps (to 0.1 % of a step) to an image, so that
/// its samples need no resampling. Returns any other data unchanged.
vtkSmartPointer<vtkDataSet> asEvenGrid(vtkSmartPointer<vtkDataSet> data);

} // namespace tessera::importer
