#include "app/importer/foam/foam_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <span>
#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace {

using PointList = std::vector<std::int32_t>;

/// The faces of one cell, each turning right round its inward normal.
struct CellFaces {
    std::vector<PointList> faces;
    PointList points; ///< each once, in ascending order
};

/// The points that edges lead to from those of a base, in its order; nothing where it is not one for each.
std::optional<PointList> oppositeOf(const CellFaces& cell, std::size_t base) {
    const PointList& corners = cell.faces[base];
    const auto isCorner = [&](std::int32_t point) { return std::ranges::find(corners, point) != corners.end(); };
    PointList opposite(corners.size(), -1);
    for (std::size_t f = 0; f < cell.faces.size(); ++f)
        for (std::size_t i = 0; f != base && i < cell.faces[f].size(); ++i) {
            const PointList& face = cell.faces[f];
            const auto corner = std::ranges::find(corners, face[i]);
            if (corner == corners.end()) continue;
            for (const std::size_t step : {std::size_t(1), face.size() - 1}) {
                const std::int32_t point = face[(i + step) % face.size()];
                if (isCorner(point)) continue;
                std::int32_t& known = opposite[std::size_t(corner - corners.begin())];
                if (known >= 0 && known != point) return std::nullopt;
                known = point;
            }
        }
    for (std::size_t i = 0; i < opposite.size(); ++i)
        if (opposite[i] < 0 || std::find(opposite.begin(), opposite.begin() + std::ptrdiff_t(i), opposite[i]) !=
                                   opposite.begin() + std::ptrdiff_t(i))
            return std::nullopt;
    return opposite;
}

/// The points of a cell in VTK's order, and its type; nothing for other polyhedra.
std::optional<std::pair<int, PointList>> shapeOf(const CellFaces& cell) {
    std::size_t triangles = 0, quads = 0;
    for (const PointList& face : cell.faces) {
        triangles += face.size() == 3 ? 1 : 0;
        quads += face.size() == 4 ? 1 : 0;
    }
    const std::size_t points = cell.points.size();
    if (triangles + quads != cell.faces.size()) return std::nullopt;
    const bool hex = triangles == 0 && quads == 6 && points == 8, wedge = triangles == 2 && quads == 3 && points == 6;
    const bool pyramid = triangles == 4 && quads == 1 && points == 5, tet = triangles == 4 && quads == 0 && points == 4;
    if (!hex && !wedge && !pyramid && !tet) return std::nullopt;
    const std::size_t corners = hex || pyramid ? 4 : 3;
    const auto base = std::ranges::find_if(cell.faces, [&](const PointList& face) { return face.size() == corners; });
    PointList out = *base;
    if (pyramid || tet) {
        for (const std::int32_t point : cell.points)
            if (std::ranges::find(*base, point) == base->end()) out.push_back(point);
        if (out.size() != points) return std::nullopt;
        return std::pair{pyramid ? VTK_PYRAMID : VTK_TETRA, out};
    }
    const std::optional<PointList> opposite = oppositeOf(cell, std::size_t(base - cell.faces.begin()));
    if (!opposite) return std::nullopt;
    out.insert(out.end(), opposite->begin(), opposite->end());
    if (wedge) { // the base of VTK's wedge turns the other way
        std::swap(out[1], out[2]);
        std::swap(out[4], out[5]);
    }
    return std::pair{hex ? VTK_HEXAHEDRON : VTK_WEDGE, out};
}

/// Gathers the cells of a grid.
struct GridMaker {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkUnsignedCharArray> types;

    void add(int type, const PointList& corners) {
        cells->InsertNextCell(static_cast<int>(corners.size()));
        for (const std::int32_t corner : corners) cells->InsertCellPoint(corner);
        types->InsertNextValue(static_cast<unsigned char>(type));
    }
};

/// Whether a tetrahedron of three points of the mesh and a fourth one has no volume.
bool isFlat(const FoamMesh& mesh, const std::array<std::int32_t, 3>& corners, const double apex[3]) {
    glm::dmat3 edges;
    for (int column = 0; column < 3; ++column)
        for (int axis = 0; axis < 3; ++axis)
            edges[column][axis] =
                mesh.points[3 * std::size_t(corners[std::size_t(column)]) + std::size_t(axis)] - apex[axis];
    const double most = glm::length(edges[0]) * glm::length(edges[1]) * glm::length(edges[2]);
    return !(std::abs(glm::determinant(edges)) > 1e-12 * most);
}

/// Per cell the faces on it: where they begin in the list, and the list.
void facesOfCells(const FoamMesh& mesh, std::vector<std::size_t>& begin, std::vector<std::int32_t>& faces) {
    begin.assign(mesh.cells + 1, 0);
    const auto each = [&](const auto& body) {
        for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
            if (mesh.owner[f] >= 0) body(std::size_t(mesh.owner[f]), f);
            if (mesh.neighbour[f] >= 0) body(std::size_t(mesh.neighbour[f]), f);
        }
    };
    each([&](std::size_t cell, std::size_t) { ++begin[cell + 1]; });
    for (std::size_t c = 0; c < mesh.cells; ++c) begin[c + 1] += begin[c];
    faces.resize(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    each([&](std::size_t cell, std::size_t face) { faces[next[cell]++] = static_cast<std::int32_t>(face); });
}

} // namespace

FoamGrid gridOfFoam(const FoamMesh& mesh) {
    FoamGrid out;
    out.ownPoints = mesh.pointCount();
    GridMaker maker;
    maker.points->SetDataTypeToDouble();
    maker.points->SetNumberOfPoints(vtkIdType(mesh.pointCount()));
    for (std::size_t p = 0; p < mesh.pointCount(); ++p) maker.points->SetPoint(vtkIdType(p), &mesh.points[3 * p]);
    std::vector<std::size_t> begin;
    std::vector<std::int32_t> faces, cellOf;
    facesOfCells(mesh, begin, faces);
    CellFaces cell;
    for (std::size_t c = 0; c < mesh.cells; ++c) {
        cell.faces.resize(begin[c + 1] - begin[c]);
        cell.points.clear();
        for (std::size_t i = 0; i < cell.faces.size(); ++i) {
            const auto f = std::size_t(faces[begin[c] + i]);
            cell.faces[i].assign(mesh.facePoints.begin() + std::ptrdiff_t(mesh.faceBegin[f]),
                                 mesh.facePoints.begin() + std::ptrdiff_t(mesh.faceBegin[f + 1]));
            if (std::size_t(mesh.owner[f]) == c) std::ranges::reverse(cell.faces[i]); // its normal points outwards
            cell.points.insert(cell.points.end(), cell.faces[i].begin(), cell.faces[i].end());
        }
        std::ranges::sort(cell.points);
        cell.points.erase(std::ranges::unique(cell.points).begin(), cell.points.end());
        if (const auto shape = shapeOf(cell)) {
            maker.add(shape->first, shape->second);
            cellOf.push_back(static_cast<std::int32_t>(c));
            continue;
        }
        if (cell.points.size() < 4) continue; // no volume
        double middle[3] = {};
        for (const std::int32_t p : cell.points)
            for (std::size_t axis = 0; axis < 3; ++axis)
                middle[axis] += mesh.points[3 * std::size_t(p) + axis] / double(cell.points.size());
        const auto apex = static_cast<std::int32_t>(maker.points->InsertNextPoint(middle));
        out.middles.push_back(static_cast<std::int32_t>(c));
        for (PointList& face : cell.faces) {
            if (face.size() < 3) continue;
            // Both cells of a face divide it alike, from its point of the lowest number.
            std::ranges::rotate(face, std::ranges::min_element(face));
            for (std::size_t i = 1; i + 1 < face.size(); ++i) {
                if (isFlat(mesh, {face[0], face[i], face[i + 1]}, middle)) continue; // points on one line
                maker.add(VTK_TETRA, {face[0], face[i], face[i + 1], apex});
                cellOf.push_back(static_cast<std::int32_t>(c));
            }
        }
    }
    out.grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    out.grid->SetPoints(maker.points);
    out.grid->SetCells(maker.types, maker.cells);
    if (!out.middles.empty() || cellOf.size() != mesh.cells) out.cellOf = std::move(cellOf);
    return out;
}

std::vector<double> toGridCells(const FoamGrid& grid, std::vector<double> values, std::size_t components) {
    if (grid.cellOf.empty()) return values;
    std::vector<double> out;
    out.reserve(grid.cellOf.size() * components);
    for (const std::int32_t cell : grid.cellOf) {
        const auto from = values.begin() + std::ptrdiff_t(std::size_t(cell) * components);
        out.insert(out.end(), from, from + std::ptrdiff_t(components));
    }
    return out;
}

std::vector<double> toGridPoints(const FoamGrid& grid, std::vector<double> values, std::size_t components) {
    const std::size_t own = grid.ownPoints;
    values.resize((own + grid.middles.size()) * components, 0.0);
    if (grid.middles.empty()) return values;
    // The points of a polyhedron are those of its tetrahedra that are not its middle; each counts once.
    std::vector<std::vector<vtkIdType>> around(grid.middles.size());
    vtkNew<vtkIdList> corners;
    for (vtkIdType c = 0; c < grid.grid->GetNumberOfCells(); ++c) {
        grid.grid->GetCellPoints(c, corners);
        const vtkIdType last = corners->GetId(corners->GetNumberOfIds() - 1);
        if (std::size_t(last) < own) continue;
        for (vtkIdType i = 0; i + 1 < corners->GetNumberOfIds(); ++i)
            around[std::size_t(last) - own].push_back(corners->GetId(i));
    }
    for (std::size_t m = 0; m < around.size(); ++m) {
        std::ranges::sort(around[m]);
        around[m].erase(std::ranges::unique(around[m]).begin(), around[m].end());
        for (const vtkIdType p : around[m])
            for (std::size_t i = 0; i < components; ++i)
                values[(own + m) * components + i] +=
                    values[std::size_t(p) * components + i] / double(around[m].size());
    }
    return values;
}

} // namespace tessera::importer
