#pragma once

#include <string>
#include <vector>
#include <vtkDataSet.h>
#include <vtkImageData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// Converts an axis-aligned structured or rectilinear grid to what needs no resampling: an image where its steps are
/// even (to 0.1 % of a step), else a rectilinear grid whose axes rise and are those of space. Its axes may run
/// backwards and in any order. Returns any other data unchanged.
vtkSmartPointer<vtkDataSet> asAlignedGrid(vtkSmartPointer<vtkDataSet> data);

/// Whether a grid needs no resampling: its axes rise, and it has values of points or of cells alone.
bool isAligned(vtkRectilinearGrid* grid);

/// Whether places along an axis are even, to 0.1 % of a step.
bool isEven(const std::vector<double>& places);

/// An image whose axes are those of space: turned round, and in another order, where its direction matrix says so.
/// `note` becomes how its axes lie where they are oblique (volume/import/files/upright.h).
vtkSmartPointer<vtkDataSet> uprightImage(vtkImageData* image, std::string& note);

} // namespace tessera::importer
