#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

/// Unstructured grids from lists of numbers of a file, which may be damaged.
namespace tessera::importer {

/// Number of corners (and points on edges) of a VTK cell type; 0 where it varies, -1 for types that are not read.
int pointsOfCell(int cellType);

/// The faces of polyhedra: cell c has faces toFaces[begins[c]..begins[c + 1]), and face f the points
/// points[faceBegins[f]..faceBegins[f + 1]). Empty where no cell is a polyhedron.
struct PolyhedronFaces {
    std::vector<std::int64_t> begins, toFaces, faceBegins, points;
};

/// The cells of a mesh: cell c has the type types[c] and the points points[begins[c]..begins[c + 1]).
struct MeshCells {
    std::vector<std::uint8_t> types;
    std::vector<std::int64_t> begins, points;
    PolyhedronFaces faces;
};

/// Three coordinates a point, from an array of one component. Throws if its size is no multiple of 3.
vtkSmartPointer<vtkPoints> pointsOf(vtkDataArray* coordinates);

/// Throws if a cell names a point that is not there, has another number of points than its type, or a type that is not
/// read.
vtkSmartPointer<vtkUnstructuredGrid> meshOf(vtkPoints* points, const MeshCells& cells);

} // namespace tessera::importer
