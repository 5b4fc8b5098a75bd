#pragma once

#include "app/importer/hdf/hdf_file.h"
#include "app/importer/hdf/mesh_cells.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The mesh of a Fluent case in HDF5 (.cas.h5): cells are those that faces lie between.
namespace tessera::importer {

/// One face as a cell sees it: its corners such that they turn to the right when seen from inside, that is, their
/// normal points into the cell; of two corners in a flat mesh.
using CellFace = std::vector<std::int64_t>;

/// A cell of VTK from its faces: a tetrahedron, hexahedron, wedge or pyramid where they make one, a polygon in a flat
/// mesh, else a polyhedron. Appended to `cells`. Gives whether it is a cell at all.
bool addFluentCell(std::span<const CellFace> faces, bool flat, MeshCells& cells);

/// A cell zone: a mesh of its own, and which of Fluent's cells its cells are.
struct FluentHdfZone {
    std::string name;
    vtkSmartPointer<vtkUnstructuredGrid> mesh;
    std::vector<std::int64_t> cells; ///< numbers from 1
};

/// Throws with one line of reason where the mesh is damaged. Cells that cannot be made are left out, with a note.
std::vector<FluentHdfZone> readFluentMesh(const HdfFile& file, std::vector<std::string>& notes);

/// Words of a list "a;b;c", which is one string or several.
std::vector<std::string> fluentWords(const HdfFile& file, const std::string& path);

} // namespace tessera::importer
