#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkUnstructuredGrid.h>

/// Meshes that are stored as faces between two cells each.
namespace tessera::importer {

/// Face f has the points points[begins[f] .. begins[f + 1]) in order round it, and lies between the cells sides[2 f]
/// and sides[2 f + 1]; -1: none.
struct FaceMesh {
    int dimensions = 3;         ///< 2: faces are lines
    std::vector<double> places; ///< x, y, z of each point
    std::vector<std::uint64_t> begins{0};
    std::vector<std::int32_t> points;
    std::vector<std::int32_t> sides;
    std::size_t cells = 0;

    std::size_t faces() const { return begins.size() - 1; }
    std::span<const std::int32_t> face(std::size_t f) const {
        return std::span(points).subspan(begins[f], begins[f + 1] - begins[f]);
    }
};

/// Faces of each cell: cell c has list[begins[c] .. begins[c + 1]).
struct FacesOfCells {
    std::vector<std::uint64_t> begins;
    std::vector<std::uint32_t> list;
};
/// `use[f]` 0: the face is left out. Throws if a face names a cell that is not there.
FacesOfCells facesOfCells(const FaceMesh& mesh, const std::vector<std::uint8_t>& use);

/// The cells [first, last) with the points that they use, or `allPoints`: tetrahedra, hexahedra, wedges and pyramids
/// where their faces make such, else polyhedra; polygons in two dimensions. Throws if a cell has too few faces or a
/// face a bad point.
vtkSmartPointer<vtkUnstructuredGrid> cellsOfFaces(const FaceMesh& mesh, const FacesOfCells& of, std::size_t first,
                                                  std::size_t last, bool allPoints = false);

} // namespace tessera::importer
