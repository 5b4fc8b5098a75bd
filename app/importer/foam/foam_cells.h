#pragma once

#include "app/importer/foam/foam_mesh.h"

#include <vector>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

/// A mesh of OpenFOAM as VTK's cells: hexahedra, wedges, pyramids and tetrahedra. Other polyhedra are divided into
/// tetrahedra round the mean of their points, which are added after the mesh's own points.
struct FoamGrid {
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    std::vector<std::int32_t> cellOf;  ///< per cell of the grid: that of the mesh; empty where all are the same
    std::vector<std::int32_t> middles; ///< per added point: the cell of the mesh it is the middle of
    std::size_t ownPoints = 0;         ///< of the mesh
};

FoamGrid gridOfFoam(const FoamMesh& mesh);

/// Values of cells of the mesh as those of cells of the grid.
std::vector<double> toGridCells(const FoamGrid& grid, std::vector<double> values, std::size_t components);

/// Values at points of the mesh as those of points of the grid: in the middle of a polyhedron the mean of its points.
std::vector<double> toGridPoints(const FoamGrid& grid, std::vector<double> values, std::size_t components);

} // namespace tessera::importer
