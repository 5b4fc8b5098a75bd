#include "app/importer/hdf/xdmf_cells.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <vtkCellType.h>

namespace tessera::importer {

namespace {

constexpr XdmfCellKind kKinds[] = {{"polyvertex", 1, VTK_POLY_VERTEX, 0},
                                   {"polyline", 2, VTK_POLY_LINE, 1},
                                   {"polygon", 3, VTK_POLYGON, 2},
                                   {"triangle", 4, VTK_TRIANGLE, 2},
                                   {"quadrilateral", 5, VTK_QUAD, 2},
                                   {"tetrahedron", 6, VTK_TETRA, 3},
                                   {"pyramid", 7, VTK_PYRAMID, 3},
                                   {"wedge", 8, VTK_WEDGE, 3},
                                   {"hexahedron", 9, VTK_HEXAHEDRON, 3},
                                   {"polyhedron", 16, VTK_POLYHEDRON, 3},
                                   {"edge_3", 34, VTK_QUADRATIC_EDGE, 1},
                                   {"quadrilateral_9", 35, VTK_BIQUADRATIC_QUAD, 2},
                                   {"quad_9", 35, VTK_BIQUADRATIC_QUAD, 2},
                                   {"triangle_6", 36, VTK_QUADRATIC_TRIANGLE, 2},
                                   {"tri_6", 36, VTK_QUADRATIC_TRIANGLE, 2},
                                   {"quadrilateral_8", 37, VTK_QUADRATIC_QUAD, 2},
                                   {"quad_8", 37, VTK_QUADRATIC_QUAD, 2},
                                   {"tetrahedron_10", 38, VTK_QUADRATIC_TETRA, 3},
                                   {"tet_10", 38, VTK_QUADRATIC_TETRA, 3},
                                   {"pyramid_13", 39, VTK_QUADRATIC_PYRAMID, 3},
                                   {"wedge_15", 40, VTK_QUADRATIC_WEDGE, 3},
                                   {"wedge_18", 41, VTK_BIQUADRATIC_QUADRATIC_WEDGE, 3},
                                   {"hexahedron_20", 48, VTK_QUADRATIC_HEXAHEDRON, 3},
                                   {"hex_20", 48, VTK_QUADRATIC_HEXAHEDRON, 3},
                                   {"hexahedron_24", 49, VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 3},
                                   {"hex_24", 49, VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 3},
                                   {"hexahedron_27", 50, VTK_TRIQUADRATIC_HEXAHEDRON, 3},
                                   {"hex_27", 50, VTK_TRIQUADRATIC_HEXAHEDRON, 3}};

/// Takes numbers from a list, one after the other.
struct Taker {
    const std::vector<std::int64_t>& list;
    std::size_t at = 0;

    bool ended() const { return at >= list.size(); }
    std::int64_t next() {
        if (ended()) throw std::runtime_error("its topology ends within a cell");
        return list[at++];
    }
    std::size_t count() {
        const std::int64_t n = next();
        if (n < 0 || std::size_t(n) > list.size())
            throw std::runtime_error("its topology has a cell of an impossible size");
        return std::size_t(n);
    }
};

void takePolyhedron(Taker& from, MeshCells& cells) {
    PolyhedronFaces& faces = cells.faces;
    const std::size_t count = from.count();
    for (std::size_t face = 0; face < count; ++face) {
        const std::size_t corners = from.count();
        for (std::size_t n = 0; n < corners; ++n) {
            faces.points.push_back(from.next());
            cells.points.push_back(faces.points.back());
        }
        faces.toFaces.push_back(std::int64_t(faces.faceBegins.size()) - 1);
        faces.faceBegins.push_back(std::int64_t(faces.points.size()));
    }
}

} // namespace

const XdmfCellKind* xdmfCellKind(const std::string& topologyType) {
    const auto found =
        std::ranges::find_if(kKinds, [&](const XdmfCellKind& kind) { return topologyType == kind.name; });
    return found == std::end(kKinds) ? nullptr : &*found;
}

MeshCells xdmfCells(const XdmfCellKind& kind, std::size_t nodes, std::vector<std::int64_t> points) {
    const int fixed = pointsOfCell(kind.vtkType);
    int type = kind.vtkType;
    if (fixed > 0) nodes = std::size_t(fixed);
    if (nodes == 0 || points.size() % nodes != 0) throw std::runtime_error("its topology ends within a cell");
    if (type == VTK_POLY_LINE && nodes == 2) type = VTK_LINE;
    MeshCells cells;
    cells.types.assign(points.size() / nodes, std::uint8_t(type));
    for (std::size_t c = 0; c <= cells.types.size(); ++c) cells.begins.push_back(std::int64_t(c * nodes));
    cells.points = std::move(points);
    return cells;
}

MeshCells xdmfMixed(const std::vector<std::int64_t>& list, std::size_t count, bool onlyPolyhedra) {
    MeshCells cells;
    cells.begins = {0};
    cells.faces.begins = {0};
    cells.faces.faceBegins = {0};
    for (Taker from{list}; !from.ended() && (count == 0 || cells.types.size() < count);) {
        const std::int64_t number = onlyPolyhedra ? 16 : from.next();
        const auto kind =
            std::ranges::find_if(kKinds, [&](const XdmfCellKind& known) { return known.number == number; });
        if (kind == std::end(kKinds))
            throw std::runtime_error("its topology has cells of the kind " + std::to_string(number) +
                                     ", which is not read");
        if (kind->vtkType == VTK_POLYHEDRON) {
            takePolyhedron(from, cells);
        } else {
            const int fixed = pointsOfCell(kind->vtkType);
            const std::size_t nodes = fixed > 0 ? std::size_t(fixed) : from.count();
            for (std::size_t n = 0; n < nodes; ++n) cells.points.push_back(from.next());
        }
        cells.types.push_back(std::uint8_t(kind->vtkType));
        cells.begins.push_back(std::int64_t(cells.points.size()));
        cells.faces.begins.push_back(std::int64_t(cells.faces.toFaces.size()));
    }
    if (count > 0 && cells.types.size() < count) throw std::runtime_error("its topology has fewer cells than stated");
    return cells;
}

} // namespace tessera::importer
