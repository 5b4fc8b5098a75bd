#include "app/importer/ensight/ensight_parts.h"

#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

struct CellKind {
    std::string_view name;
    std::size_t nodes; ///< 0: it varies
    int vtkType, dimension;
};
// Corners and middles of edges are in the order of VTK's. A wedge of EnSight is turned inside out in VTK's view, which
// matters to surfaces only.
constexpr CellKind kCellKinds[] = {{"point", 1, VTK_VERTEX, 0},
                                   {"bar2", 2, VTK_LINE, 1},
                                   {"bar3", 3, VTK_QUADRATIC_EDGE, 1},
                                   {"tria3", 3, VTK_TRIANGLE, 2},
                                   {"tria6", 6, VTK_QUADRATIC_TRIANGLE, 2},
                                   {"quad4", 4, VTK_QUAD, 2},
                                   {"quad8", 8, VTK_QUADRATIC_QUAD, 2},
                                   {"nsided", 0, VTK_POLYGON, 2},
                                   {"tetra4", 4, VTK_TETRA, 3},
                                   {"tetra10", 10, VTK_QUADRATIC_TETRA, 3},
                                   {"pyramid5", 5, VTK_PYRAMID, 3},
                                   {"pyramid13", 13, VTK_QUADRATIC_PYRAMID, 3},
                                   {"penta6", 6, VTK_WEDGE, 3},
                                   {"penta15", 15, VTK_QUADRATIC_WEDGE, 3},
                                   {"hexa8", 8, VTK_HEXAHEDRON, 3},
                                   {"hexa20", 20, VTK_QUADRATIC_HEXAHEDRON, 3},
                                   {"nfaced", 0, VTK_POLYHEDRON, 3}};

const CellKind* cellKindOf(std::string_view type) {
    if (type.starts_with("g_")) type.remove_prefix(2);
    const auto at = std::ranges::find(kCellKinds, type, &CellKind::name);
    return at == std::end(kCellKinds) ? nullptr : at;
}

std::string firstWord(const std::string& line) {
    return line.substr(0, line.find_first_of(" \t"));
}

std::size_t sumOf(const std::vector<std::int32_t>& counts) {
    std::size_t sum = 0;
    for (const std::int32_t n : counts) {
        if (n < 0) throw std::runtime_error("has a cell with a negative number of corners");
        sum += std::size_t(n);
    }
    return sum;
}

EnSightCells readCellsOf(EnSightBytes& file, const std::string& type, bool ids) {
    EnSightCells cells;
    cells.type = type;
    const CellKind& kind = *cellKindOf(type);
    cells.count = file.count("cells");
    if (ids) file.skip(cells.count);
    if (kind.nodes > 0) {
        cells.nodes = file.integers(cells.count * kind.nodes);
        return cells;
    }
    cells.pieces = file.integers(cells.count);
    if (kind.vtkType == VTK_POLYHEDRON) cells.corners = file.integers(sumOf(cells.pieces));
    cells.nodes = file.integers(sumOf(kind.vtkType == VTK_POLYHEDRON ? cells.corners : cells.pieces));
    return cells;
}

void readBlock(EnSightBytes& file, const std::string& line, EnSightPart& part) {
    const auto has = [&](const char* word) { return line.find(word) != std::string::npos; };
    part.kind = EnSightPart::Kind::Curvilinear;
    if (has("rectilinear")) part.kind = EnSightPart::Kind::Rectilinear;
    if (has("uniform")) part.kind = EnSightPart::Kind::Uniform;
    std::vector<std::int32_t> size = file.integers(3);
    if (has("range")) {
        const std::vector<std::int32_t> range = file.integers(6);
        for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = range[2 * axis + 1] - range[2 * axis] + 1;
    }
    double points = 1;
    std::size_t cells = 1, sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (size[axis] < 1 || (points *= size[axis]) > 1e10) throw std::runtime_error("has a block of a bad size");
        part.size[axis] = size[axis];
        cells *= std::size_t(std::max(1, size[axis] - 1));
        sum += std::size_t(size[axis]);
    }
    part.points = std::size_t(points);
    part.places = file.numbers(part.kind == EnSightPart::Kind::Uniform       ? 6
                               : part.kind == EnSightPart::Kind::Rectilinear ? sum
                                                                             : 3 * part.points);
    if (has("iblanked")) part.blanks = file.integers(part.points);
    const std::string next = has("with_ghost") ? file.ahead() : "";
    if (next == "ghost_flags") {
        file.line();
        part.ghosts = file.integers(cells);
    }
    if (file.ahead() == "node_ids") {
        file.line();
        file.skip(part.points);
    }
    if (file.ahead() == "element_ids") {
        file.line();
        file.skip(cells);
    }
}

/// Indices of the values that a section states, where these are not all: "undef" names the number for none, "partial"
/// lists those that follow.
std::vector<float> readSection(EnSightBytes& file, const std::string& line, std::size_t count, std::size_t components) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    if (line.find("undef") != std::string::npos) {
        const float undefined = file.numbers(1)[0];
        std::vector<float> values = file.numbers(components * count);
        std::ranges::replace(values, undefined, kNone);
        return values;
    }
    if (line.find("partial") == std::string::npos) return file.numbers(components * count);
    const std::vector<std::int32_t> where = file.integers(file.count("values"));
    std::vector<float> values(components * count, kNone);
    for (std::size_t c = 0; c < components; ++c) {
        const std::vector<float> some = file.numbers(where.size());
        for (std::size_t n = 0; n < where.size(); ++n) {
            if (where[n] < 1 || std::size_t(where[n]) > count)
                throw std::runtime_error("has a value of a point or cell that does not exist");
            values[c * count + std::size_t(where[n]) - 1] = some[n];
        }
    }
    return values;
}

void addCell(const EnSightCells& cells, const CellKind& kind, std::size_t c, std::size_t& node, std::size_t& face,
             std::size_t points, vtkUnstructuredGrid& mesh) {
    std::vector<vtkIdType> ids;
    const auto take = [&](std::size_t count) {
        for (std::size_t n = 0; n < count; ++n) {
            const std::int32_t id = cells.nodes[node++];
            if (id < 1 || std::size_t(id) > points) throw std::runtime_error("has a cell with a bad corner");
            ids.push_back(id - 1);
        }
    };
    if (kind.vtkType != VTK_POLYHEDRON) {
        take(kind.nodes > 0 ? kind.nodes : std::size_t(cells.pieces[c]));
        mesh.InsertNextCell(kind.vtkType, vtkIdType(ids.size()), ids.data());
        return;
    }
    const auto faces = std::size_t(cells.pieces[c]);
    for (std::size_t f = 0; f < faces; ++f) {
        const auto corners = std::size_t(cells.corners[face++]);
        ids.push_back(vtkIdType(corners));
        take(corners);
    }
    mesh.InsertNextCell(VTK_POLYHEDRON, vtkIdType(faces), ids.data());
}

EnSightGrid meshOf(const EnSightPart& part) {
    int highest = 0;
    for (const EnSightCells& cells : part.cells)
        if (cells.count > 0) highest = std::max(highest, cellKindOf(cells.type)->dimension);
    EnSightGrid out;
    vtkNew<vtkUnstructuredGrid> mesh;
    mesh->Allocate(vtkIdType(part.cellCount()));
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName("vtkGhostType");
    bool anyGhost = false;
    std::size_t place = 0;
    for (const EnSightCells& cells : part.cells) {
        const CellKind& kind = *cellKindOf(cells.type);
        const bool ghost = cells.type.starts_with("g_");
        if (kind.dimension < highest) {
            out.left += cells.count;
            place += cells.count;
            continue;
        }
        std::size_t node = 0, face = 0;
        for (std::size_t c = 0; c < cells.count; ++c) {
            addCell(cells, kind, c, node, face, part.points, *mesh);
            out.kept.push_back(place++);
            ghosts->InsertNextValue(ghost ? vtkDataSetAttributes::DUPLICATECELL : 0);
        }
        anyGhost = anyGhost || ghost;
    }
    if (mesh->GetNumberOfCells() == 0) return {};
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(vtkIdType(part.points));
    for (std::size_t n = 0; n < part.points; ++n)
        points->SetPoint(vtkIdType(n), part.places[n], part.places[part.points + n], part.places[2 * part.points + n]);
    mesh->SetPoints(points);
    if (anyGhost) mesh->GetCellData()->AddArray(ghosts);
    out.data = mesh;
    return out;
}

vtkSmartPointer<vtkDataSet> blockOf(const EnSightPart& part) {
    const auto [i, j, k] = part.size;
    if (part.kind == EnSightPart::Kind::Uniform) {
        vtkNew<vtkImageData> image;
        image->SetDimensions(i, j, k);
        image->SetOrigin(part.places[0], part.places[1], part.places[2]);
        image->SetSpacing(part.places[3], part.places[4], part.places[5]);
        return image;
    }
    if (part.kind == EnSightPart::Kind::Rectilinear) {
        vtkNew<vtkRectilinearGrid> grid;
        grid->SetDimensions(i, j, k);
        std::size_t at = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            vtkNew<vtkFloatArray> places;
            for (int n = 0; n < part.size[axis]; ++n) places->InsertNextValue(part.places[at++]);
            axis == 0   ? grid->SetXCoordinates(places)
            : axis == 1 ? grid->SetYCoordinates(places)
                        : grid->SetZCoordinates(places);
        }
        return grid;
    }
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(i, j, k);
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(vtkIdType(part.points));
    for (std::size_t n = 0; n < part.points; ++n)
        points->SetPoint(vtkIdType(n), part.places[n], part.places[part.points + n], part.places[2 * part.points + n]);
    grid->SetPoints(points);
    return grid;
}

/// Marks the points or cells of a block: `none` where a flag is 0, else `some`.
void addMarks(const std::vector<std::int32_t>& flags, const char* name, unsigned char none, unsigned char some,
              vtkDataSetAttributes* to) {
    if (flags.empty()) return;
    vtkNew<vtkUnsignedCharArray> marks;
    marks->SetName(name);
    for (const std::int32_t flag : flags) marks->InsertNextValue(flag == 0 ? none : some);
    to->AddArray(marks);
}

} // namespace

std::size_t EnSightPart::cellCount() const {
    if (kind == Kind::Cells)
        return std::accumulate(cells.begin(), cells.end(), std::size_t(0),
                               [](std::size_t sum, const EnSightCells& one) { return sum + one.count; });
    std::size_t count = 1;
    for (const int n : size) count *= std::size_t(std::max(1, n - 1));
    return count;
}

std::vector<EnSightPart> readEnSightParts(EnSightBytes& file) {
    file.line();
    file.line();
    const auto listed = [](const std::string& line) {
        return line.find("given") != std::string::npos || line.find("ignore") != std::string::npos;
    };
    const bool nodeIds = listed(file.line()), cellIds = listed(file.line());
    if (file.ahead().starts_with("extents")) {
        file.line();
        file.skip(6);
    }
    std::vector<EnSightPart> parts;
    while (!file.atEnd()) {
        if (const std::string line = file.line(); !line.starts_with("part"))
            throw std::runtime_error("has \"" + line.substr(0, 40) + "\" where a part belongs");
        EnSightPart& part = parts.emplace_back();
        part.number = file.integer();
        part.name = file.line();
        const std::string line = file.atEnd() ? "" : file.ahead();
        if (line.starts_with("block")) {
            file.line();
            readBlock(file, line, part);
            continue;
        }
        if (!line.starts_with("coordinates")) { // a part without anything
            if (line.empty() || line.starts_with("part")) continue;
            throw std::runtime_error("has \"" + line.substr(0, 40) + "\" where coordinates belong");
        }
        file.line();
        part.points = file.count("points");
        if (nodeIds) file.skip(part.points);
        part.places = file.numbers(3 * part.points);
        for (std::string type; cellKindOf(type = firstWord(file.ahead())) != nullptr;) {
            file.line();
            part.cells.push_back(readCellsOf(file, type, cellIds));
        }
    }
    return parts;
}

std::vector<std::optional<EnSightValues>> readEnSightValues(EnSightBytes& file, const std::vector<EnSightPart>& parts,
                                                            std::size_t components, bool ofCells) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::optional<EnSightValues>> out(parts.size());
    file.line();
    while (!file.atEnd()) {
        if (const std::string line = file.line(); !line.starts_with("part"))
            throw std::runtime_error("has \"" + line.substr(0, 40) + "\" where a part belongs");
        const int number = file.integer();
        const auto part = std::ranges::find(parts, number, &EnSightPart::number);
        if (part == parts.end())
            throw std::runtime_error("has values of part " + std::to_string(number) + ", which the geometry lacks");
        EnSightValues& values = out[std::size_t(part - parts.begin())].emplace();
        const std::size_t all = ofCells ? part->cellCount() : part->points;
        std::vector<bool> read(part->cells.size());
        refuseHollow(4.0 * double(all) * double(components), double(file.left()));
        values.values.assign(all * components, kNone);
        while (!file.atEnd() && !file.ahead().starts_with("part")) {
            const std::string line = file.line(), type = firstWord(line);
            std::size_t begin = 0, count = all;
            if (type != "coordinates" && type != "block") {
                const auto cells = std::ranges::find(part->cells, type, &EnSightCells::type);
                if (cells == part->cells.end() || !ofCells)
                    throw std::runtime_error("has values of \"" + line.substr(0, 40) + "\" that part " +
                                             std::to_string(number) + " lacks");
                for (auto at = part->cells.begin(); at != cells; ++at) begin += at->count;
                count = cells->count;
                read[std::size_t(cells - part->cells.begin())] = true;
            }
            const std::vector<float> some = readSection(file, line, count, components);
            for (std::size_t c = 0; c < components; ++c)
                std::copy_n(some.begin() + std::ptrdiff_t(c * count), count,
                            values.values.begin() + std::ptrdiff_t(c * all + begin));
        }
        if (ofCells && part->kind == EnSightPart::Kind::Cells && file.atEnd() && std::ranges::count(read, false) > 0)
            throw std::runtime_error("ends before its last cells: truncated");
    }
    return out;
}

EnSightGrid gridOfPart(const EnSightPart& part) {
    if (part.points == 0) return {};
    if (part.kind == EnSightPart::Kind::Cells) return meshOf(part);
    EnSightGrid out;
    out.data = blockOf(part);
    addMarks(part.blanks, "vtkValidPointMask", 0, 1, out.data->GetPointData()); // takes no cells away
    addMarks(part.ghosts, "vtkGhostType", 0, vtkDataSetAttributes::DUPLICATECELL, out.data->GetCellData());
    return out;
}

} // namespace tessera::importer
