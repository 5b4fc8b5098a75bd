#pragma once

#include <string>
#include <vtkDataSet.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// Converts an axis-aligned structured or rectilinear grid with even steps (to 0.1 % of a step) to an image, so that
/// its samples need no resampling; its axes may run backwards and in any order. Returns any other data unchanged.
vtkSmartPointer<vtkDataSet> asEvenGrid(vtkSmartPointer<vtkDataSet> data);

/// An image whose axes are those of space: turned round, and in another order, where its direction matrix says so.
/// `note` becomes how its axes lie where they are oblique (volume/import/files/upright.h).
vtkSmartPointer<vtkDataSet> uprightImage(vtkImageData* image, std::string& note);

} // namespace tessera::importer
