#include "app/importer/hdf/mesh_cells.h"

#include <algorithm>
#include <stdexcept>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace {

[[noreturn]] void badCells(const std::string& reason) {
    throw std::runtime_error("its cells are damaged: " + reason);
}

/// [begins[i], begins[i + 1]) must lie in a list of `size`.
void checkBegins(std::span<const std::int64_t> begins, std::size_t count, std::size_t size) {
    if (begins.size() != count + 1) badCells("a list has another length than the number of cells");
    for (std::size_t i = 0; i < count; ++i)
        if (begins[i] < 0 || begins[i] > begins[i + 1]) badCells("positions in a list do not increase");
    if (begins[count] > std::int64_t(size)) badCells("a list ends early");
}

void checkPoints(std::span<const std::int64_t> list, vtkIdType points) {
    for (const std::int64_t p : list)
        if (p < 0 || p >= points) badCells("a cell names point " + std::to_string(p) + " of " + std::to_string(points));
}

/// Whether a Lagrange cell with so many points has one order along all its axes; others need more than their points to
/// be understood.
bool isWholeOrder(int cellType, std::int64_t points) {
    for (std::int64_t n = 2; n < 12; ++n) { // points along an edge
        const std::int64_t triangle = n * (n + 1) / 2;
        const std::int64_t wanted = cellType == VTK_LAGRANGE_CURVE           ? n
                                    : cellType == VTK_LAGRANGE_TRIANGLE      ? triangle
                                    : cellType == VTK_LAGRANGE_QUADRILATERAL ? n * n
                                    : cellType == VTK_LAGRANGE_TETRAHEDRON   ? triangle * (n + 2) / 3
                                    : cellType == VTK_LAGRANGE_HEXAHEDRON    ? n * n * n
                                    : cellType == VTK_LAGRANGE_WEDGE         ? triangle * n
                                                                             : n * (n + 1) * (2 * n + 1) / 6;
        if (points == wanted) return true;
    }
    return false;
}

void addPolyhedron(vtkUnstructuredGrid& mesh, const MeshCells& cells, std::size_t c) {
    const PolyhedronFaces& faces = cells.faces;
    std::vector<vtkIdType> list, corners;
    const auto faceCount = std::int64_t(faces.faceBegins.size()) - 1;
    for (std::int64_t at = faces.begins[c]; at < faces.begins[c + 1]; ++at) {
        const std::int64_t face = faces.toFaces[std::size_t(at)];
        if (face < 0 || face >= faceCount) badCells("a cell names a face that is not there");
        const std::int64_t begin = faces.faceBegins[std::size_t(face)], end = faces.faceBegins[std::size_t(face) + 1];
        if (end - begin < 3) badCells("a face has fewer than 3 points");
        list.push_back(vtkIdType(end - begin));
        for (std::int64_t p = begin; p < end; ++p) {
            list.push_back(vtkIdType(faces.points[std::size_t(p)]));
            corners.push_back(list.back());
        }
    }
    const std::int64_t count = faces.begins[c + 1] - faces.begins[c];
    if (count < 4) badCells("a polyhedron has fewer than 4 faces");
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    mesh.InsertNextCell(VTK_POLYHEDRON, vtkIdType(corners.size()), corners.data(), vtkIdType(count), list.data());
}

} // namespace

int pointsOfCell(int cellType) {
    switch (cellType) {
    case VTK_VERTEX:
        return 1;
    case VTK_LINE:
        return 2;
    case VTK_TRIANGLE:
    case VTK_QUADRATIC_EDGE:
        return 3;
    case VTK_PIXEL:
    case VTK_QUAD:
    case VTK_TETRA:
        return 4;
    case VTK_PYRAMID:
        return 5;
    case VTK_WEDGE:
    case VTK_QUADRATIC_TRIANGLE:
        return 6;
    case VTK_VOXEL:
    case VTK_HEXAHEDRON:
    case VTK_QUADRATIC_QUAD:
        return 8;
    case VTK_BIQUADRATIC_QUAD:
        return 9;
    case VTK_QUADRATIC_TETRA:
        return 10;
    case VTK_QUADRATIC_PYRAMID:
        return 13;
    case VTK_QUADRATIC_WEDGE:
        return 15;
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
        return 18;
    case VTK_QUADRATIC_HEXAHEDRON:
        return 20;
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
        return 24;
    case VTK_TRIQUADRATIC_HEXAHEDRON:
        return 27;
    case VTK_POLY_VERTEX:
    case VTK_POLY_LINE:
    case VTK_POLYGON:
    case VTK_TRIANGLE_STRIP:
    case VTK_POLYHEDRON:
        return 0;
    default:
        return cellType >= VTK_LAGRANGE_CURVE && cellType <= VTK_LAGRANGE_PYRAMID ? 0 : -1;
    }
}

vtkSmartPointer<vtkPoints> pointsOf(vtkDataArray* coordinates) {
    if (coordinates->GetNumberOfValues() % 3 != 0) throw std::runtime_error("has points without three coordinates");
    coordinates->SetNumberOfComponents(3);
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetData(coordinates);
    return points;
}

vtkSmartPointer<vtkUnstructuredGrid> meshOf(vtkPoints* points, const MeshCells& cells) {
    const std::size_t count = cells.types.size();
    checkBegins(cells.begins, count, cells.points.size());
    checkPoints(cells.points, points->GetNumberOfPoints());
    bool polyhedra = false;
    for (std::size_t c = 0; c < count; ++c) {
        const int type = cells.types[c], wanted = pointsOfCell(type);
        if (wanted < 0) badCells("cells of VTK's type " + std::to_string(type) + " are not read");
        if (wanted > 0 && cells.begins[c + 1] - cells.begins[c] != wanted)
            badCells("a cell has another number of points than its type");
        const bool lagrange = type >= VTK_LAGRANGE_CURVE && type <= VTK_LAGRANGE_PYRAMID;
        if (lagrange && !isWholeOrder(type, cells.begins[c + 1] - cells.begins[c]))
            badCells("a Lagrange cell has another number of points than its order");
        polyhedra = polyhedra || type == VTK_POLYHEDRON;
    }
    auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    mesh->SetPoints(points);
    if (polyhedra) {
        const PolyhedronFaces& faces = cells.faces;
        checkBegins(faces.begins, count, faces.toFaces.size());
        checkBegins(faces.faceBegins, std::max<std::size_t>(faces.faceBegins.size(), 1) - 1, faces.points.size());
        checkPoints(faces.points, points->GetNumberOfPoints());
        mesh->Allocate(vtkIdType(count));
        for (std::size_t c = 0; c < count; ++c) {
            if (cells.types[c] == VTK_POLYHEDRON) {
                addPolyhedron(*mesh, cells, c);
                continue;
            }
            const std::vector<vtkIdType> corners(cells.points.begin() + cells.begins[c],
                                                 cells.points.begin() + cells.begins[c + 1]);
            mesh->InsertNextCell(cells.types[c], vtkIdType(corners.size()), corners.data());
        }
        return mesh;
    }
    vtkNew<vtkUnsignedCharArray> types;
    types->SetNumberOfTuples(vtkIdType(count));
    std::copy(cells.types.begin(), cells.types.end(), types->GetPointer(0));
    vtkNew<vtkIdTypeArray> begins, corners;
    begins->SetNumberOfTuples(vtkIdType(count + 1));
    std::copy(cells.begins.begin(), cells.begins.end(), begins->GetPointer(0));
    corners->SetNumberOfTuples(vtkIdType(cells.begins[count]));
    std::copy(cells.points.begin(), cells.points.begin() + cells.begins[count], corners->GetPointer(0));
    vtkNew<vtkCellArray> list;
    list->SetData(begins, corners);
    mesh->SetCells(types, list);
    return mesh;
}

} // namespace tessera::importer
