#include "app/importer/hdf/fluent_mesh.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vtkCellType.h>

namespace tessera::importer {

namespace {

bool hasCorner(std::span<const std::int64_t> list, std::int64_t corner) {
    return std::ranges::find(list, corner) != list.end();
}

/// The corner that an edge joins to `corner` and that is not of the base.
std::optional<std::int64_t> above(std::span<const CellFace> faces, const CellFace& base, std::int64_t corner) {
    for (const CellFace& face : faces) {
        if (&face == &base) continue;
        for (std::size_t n = 0; n < face.size(); ++n) {
            if (face[n] != corner) continue;
            for (const std::size_t next : {(n + 1) % face.size(), (n + face.size() - 1) % face.size()})
                if (!hasCorner(base, face[next])) return face[next];
        }
    }
    return std::nullopt;
}

void finishCell(MeshCells& cells, int type) {
    cells.types.push_back(std::uint8_t(type));
    cells.begins.push_back(std::int64_t(cells.points.size()));
    cells.faces.begins.push_back(std::int64_t(cells.faces.toFaces.size()));
}

/// Edges one after the other.
bool addPolygon(std::span<const CellFace> edges, MeshCells& cells) {
    if (edges.size() < 3) return false;
    std::vector<bool> used(edges.size(), false);
    std::vector<std::int64_t> ring{edges[0][0]};
    std::int64_t at = edges[0][1];
    used[0] = true;
    while (at != ring.front()) {
        ring.push_back(at);
        std::size_t next = edges.size();
        for (std::size_t e = 0; e < edges.size(); ++e)
            if (!used[e] && hasCorner(edges[e], at)) next = e;
        if (next == edges.size()) return false;
        used[next] = true;
        at = edges[next][0] == at ? edges[next][1] : edges[next][0];
    }
    if (ring.size() != edges.size()) return false;
    cells.points.insert(cells.points.end(), ring.begin(), ring.end());
    finishCell(cells, ring.size() == 3 ? VTK_TRIANGLE : ring.size() == 4 ? VTK_QUAD : VTK_POLYGON);
    return true;
}

bool addPolyhedronOf(std::span<const CellFace> faces, MeshCells& cells) {
    if (faces.size() < 4) return false;
    PolyhedronFaces& all = cells.faces;
    if (all.faceBegins.empty()) all.faceBegins = {0};
    std::vector<std::int64_t> corners;
    for (const CellFace& face : faces) {
        all.toFaces.push_back(std::int64_t(all.faceBegins.size()) - 1);
        all.points.insert(all.points.end(), face.rbegin(), face.rend()); // seen from outside
        all.faceBegins.push_back(std::int64_t(all.points.size()));
        corners.insert(corners.end(), face.begin(), face.end());
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    cells.points.insert(cells.points.end(), corners.begin(), corners.end());
    finishCell(cells, VTK_POLYHEDRON);
    return true;
}

/// The base and what lies above each of its corners.
bool addPrism(std::span<const CellFace> faces, const CellFace& base, int type, MeshCells& cells) {
    CellFace corners = base;
    if (type == VTK_WEDGE) std::reverse(corners.begin(), corners.end()); // the normal of its base points outwards
    std::vector<std::int64_t> top;
    for (const std::int64_t corner : corners) {
        const std::optional<std::int64_t> other = above(faces, base, corner);
        if (!other || hasCorner(top, *other)) return false;
        top.push_back(*other);
    }
    cells.points.insert(cells.points.end(), corners.begin(), corners.end());
    cells.points.insert(cells.points.end(), top.begin(), top.end());
    finishCell(cells, type);
    return true;
}

bool addPointed(std::span<const CellFace> faces, const CellFace& base, int type, MeshCells& cells) {
    const std::optional<std::int64_t> apex = above(faces, base, base.front());
    if (!apex) return false;
    cells.points.insert(cells.points.end(), base.begin(), base.end());
    cells.points.push_back(*apex);
    finishCell(cells, type);
    return true;
}

} // namespace

bool addFluentCell(std::span<const CellFace> faces, bool flat, MeshCells& cells) {
    if (cells.begins.empty()) cells.begins = {0};
    if (cells.faces.begins.empty()) cells.faces.begins = {0};
    if (flat) return addPolygon(faces, cells);
    std::size_t triangles = 0, quads = 0;
    const CellFace *triangle = nullptr, *quad = nullptr;
    for (const CellFace& face : faces) {
        triangles += face.size() == 3 ? 1 : 0;
        quads += face.size() == 4 ? 1 : 0;
        if (face.size() == 3) triangle = &face;
        if (face.size() == 4) quad = &face;
    }
    if (triangles + quads == faces.size()) {
        if (quads == 0 && triangles == 4 && addPointed(faces, *triangle, VTK_TETRA, cells)) return true;
        if (quads == 1 && triangles == 4 && addPointed(faces, *quad, VTK_PYRAMID, cells)) return true;
        if (quads == 3 && triangles == 2 && addPrism(faces, *triangle, VTK_WEDGE, cells)) return true;
        if (quads == 6 && triangles == 0 && addPrism(faces, *quad, VTK_HEXAHEDRON, cells)) return true;
    }
    return addPolyhedronOf(faces, cells);
}

} // namespace tessera::importer
