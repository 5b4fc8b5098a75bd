#include "app/importer/fluent/face_cells.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vtkCellType.h>
#include <vtkNew.h>
#include <vtkPoints.h>

namespace tessera::importer {

namespace {

using Face = std::span<const std::int32_t>;

[[noreturn]] void badCell(std::size_t cell, const char* reason) {
    throw std::runtime_error("has a cell (" + std::to_string(cell + 1) + ") " + reason);
}

bool holds(std::span<const std::int32_t> points, std::int32_t point) {
    return std::ranges::find(points, point) != points.end();
}

/// The corner that an edge of another face leads to from a corner of the base; -1: none, or several.
std::int32_t across(std::span<const Face> faces, std::size_t base, std::int32_t corner) {
    std::int32_t found = -1;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (f == base) continue;
        const auto at = std::ranges::find(faces[f], corner);
        if (at == faces[f].end()) continue;
        const auto n = std::size_t(at - faces[f].begin()), count = faces[f].size();
        for (const std::int32_t next : {faces[f][(n + 1) % count], faces[f][(n + count - 1) % count]}) {
            if (holds(faces[base], next)) continue;
            if (found >= 0 && found != next) return -1;
            found = next;
        }
    }
    return found;
}

struct PlainCell {
    int type = VTK_EMPTY_CELL;
    std::vector<std::int32_t> corners;
};

/// A tetrahedron, hexahedron, wedge or pyramid, if these faces make one.
PlainCell plainCell(std::span<const Face> faces) {
    const auto ofSize = [&](std::size_t size) {
        return std::size_t(std::ranges::count_if(faces, [&](const Face& face) { return face.size() == size; }));
    };
    const std::size_t triangles = ofSize(3), quads = ofSize(4);
    if (triangles + quads != faces.size()) return {};
    const auto firstOf = [&](std::size_t size) {
        return std::size_t(std::ranges::find_if(faces, [&](const Face& face) { return face.size() == size; }) -
                           faces.begin());
    };
    PlainCell cell;
    std::size_t base = 0;
    bool apex = false; // else as many corners above as below
    if (triangles == 4 && quads == 0) {
        cell.type = VTK_TETRA;
        apex = true;
    } else if (triangles == 4 && quads == 1) {
        cell.type = VTK_PYRAMID;
        base = firstOf(4);
        apex = true;
    } else if (triangles == 2 && quads == 3) {
        cell.type = VTK_WEDGE;
        base = firstOf(3);
    } else if (triangles == 0 && quads == 6) {
        cell.type = VTK_HEXAHEDRON;
    } else {
        return {};
    }
    cell.corners.assign(faces[base].begin(), faces[base].end());
    std::vector<std::int32_t> above;
    for (const std::int32_t corner : faces[base]) {
        const std::int32_t over = across(faces, base, corner);
        if (over < 0) return {};
        if (!holds(above, over)) above.push_back(over);
    }
    if (above.size() != (apex ? 1 : cell.corners.size())) return {};
    cell.corners.insert(cell.corners.end(), above.begin(), above.end());
    return cell;
}

/// The corners of a polygon from its edges; empty if they do not close.
std::vector<std::int32_t> roundOf(std::span<const Face> edges) {
    std::vector<std::int32_t> corners;
    std::vector<bool> used(edges.size());
    if (edges.empty() || edges[0].size() != 2) return {};
    used[0] = true;
    corners.assign(edges[0].begin(), edges[0].end());
    while (corners.size() <= edges.size()) {
        std::size_t next = 0;
        while (next < edges.size() && (used[next] || edges[next].size() != 2 || !holds(edges[next], corners.back())))
            ++next;
        if (next == edges.size()) return {};
        used[next] = true;
        corners.push_back(edges[next][0] == corners.back() ? edges[next][1] : edges[next][0]);
    }
    if (corners.front() != corners.back()) return {};
    corners.pop_back();
    return corners;
}

/// Numbers the points that are used, from 0.
class UsedPoints {
public:
    explicit UsedPoints(const FaceMesh& mesh) : mesh_(mesh), number_(mesh.places.size() / 3, -1) {
        points_->SetDataTypeToDouble();
    }
    vtkIdType operator()(std::int32_t point) {
        if (point < 0 || std::size_t(point) >= number_.size())
            throw std::runtime_error("has a face with a point that is not there");
        std::int32_t& number = number_[std::size_t(point)];
        if (number < 0) {
            number = std::int32_t(points_->GetNumberOfPoints());
            points_->InsertNextPoint(mesh_.places.data() + 3 * std::size_t(point));
        }
        return number;
    }
    vtkPoints* points() const { return points_; }

private:
    const FaceMesh& mesh_;
    std::vector<std::int32_t> number_;
    vtkSmartPointer<vtkPoints> points_ = vtkSmartPointer<vtkPoints>::New();
};

} // namespace

FacesOfCells facesOfCells(const FaceMesh& mesh, const std::vector<std::uint8_t>& use) {
    FacesOfCells of;
    of.begins.assign(mesh.cells + 1, 0);
    const auto each = [&](auto&& body) {
        for (std::size_t f = 0; f < mesh.faces(); ++f)
            for (std::size_t side = 0; side < 2 && use[f] != 0; ++side)
                if (const std::int32_t cell = mesh.sides[2 * f + side]; cell >= 0) body(f, std::size_t(cell));
    };
    each([&](std::size_t, std::size_t cell) {
        if (cell >= mesh.cells) throw std::runtime_error("has a face of a cell that is not there");
        ++of.begins[cell + 1];
    });
    for (std::size_t c = 0; c < mesh.cells; ++c) of.begins[c + 1] += of.begins[c];
    of.list.resize(of.begins.back());
    std::vector<std::uint64_t> next(of.begins.begin(), of.begins.end() - 1);
    each([&](std::size_t f, std::size_t cell) { of.list[next[cell]++] = std::uint32_t(f); });
    return of;
}

vtkSmartPointer<vtkUnstructuredGrid> cellsOfFaces(const FaceMesh& mesh, const FacesOfCells& of, std::size_t first,
                                                  std::size_t last, bool allPoints) {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->Allocate(vtkIdType(last - first));
    UsedPoints used(mesh);
    for (std::size_t p = 0; allPoints && p < mesh.places.size() / 3; ++p) used(std::int32_t(p));
    std::vector<Face> faces;
    std::vector<vtkIdType> ids;
    for (std::size_t c = first; c < last; ++c) {
        faces.clear();
        ids.clear();
        for (std::uint64_t at = of.begins[c]; at < of.begins[c + 1]; ++at) faces.push_back(mesh.face(of.list[at]));
        if (mesh.dimensions == 2) {
            const std::vector<std::int32_t> corners = roundOf(faces);
            if (corners.size() < 3) badCell(c, "whose edges do not close");
            for (const std::int32_t corner : corners) ids.push_back(used(corner));
            const int type = ids.size() == 3 ? VTK_TRIANGLE : ids.size() == 4 ? VTK_QUAD : VTK_POLYGON;
            grid->InsertNextCell(type, vtkIdType(ids.size()), ids.data());
            continue;
        }
        if (faces.size() < 4) badCell(c, "with fewer than four faces");
        if (const PlainCell cell = plainCell(faces); cell.type != VTK_EMPTY_CELL) {
            for (const std::int32_t corner : cell.corners) ids.push_back(used(corner));
            grid->InsertNextCell(cell.type, vtkIdType(ids.size()), ids.data());
            continue;
        }
        for (const Face& face : faces) {
            if (face.size() < 3) badCell(c, "with a face of fewer than three points");
            ids.push_back(vtkIdType(face.size()));
            for (const std::int32_t corner : face) ids.push_back(used(corner));
        }
        grid->InsertNextCell(VTK_POLYHEDRON, vtkIdType(faces.size()), ids.data());
    }
    grid->SetPoints(used.points());
    return grid;
}

} // namespace tessera::importer
