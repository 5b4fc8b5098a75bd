#include "app/importer/tecplot/tecplot_zones.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>

namespace tessera::importer {

namespace {

constexpr double kMostPoints = 1e12; // in a zone

/// A zone with the type of each of its variables, which must be equal at all times.
struct Part {
    const TecplotZone& zone;
    const std::vector<int>& types;
    const std::vector<Heading>& headings;

    /// Indices of the variables with values, in order.
    std::vector<std::size_t> variables(bool ofCells) const {
        std::vector<std::size_t> out;
        for (std::size_t v = 0; v < headings.size(); ++v)
            if (types[v] != VTK_VOID && zone.ofCells[v] == ofCells) out.push_back(v);
        return out;
    }
    std::vector<double> values(std::size_t variable) const {
        if (zone.types[variable] != VTK_VOID) return zone.values(variable);
        return std::vector<double>(zone.ofCells[variable] ? zone.cells : zone.points,
                                   std::numeric_limits<double>::quiet_NaN());
    }
    PointTable table(std::span<const std::size_t> wanted, bool read = true) const {
        PointTable out;
        for (const std::size_t v : wanted) {
            out.headings.push_back(headings[v]);
            out.types.push_back(types[v]);
            out.columns.push_back(read ? values(v) : std::vector<double>());
        }
        return out;
    }
    /// Throws if the zone has no coordinates. Reading them also proves that its numbers of points and cells are
    /// correct.
    void needPlaces() const {
        bool found[3] = {};
        for (const std::size_t v : variables(false))
            if (const int axis = axisOf(headings[v].name); axis >= 0 && zone.types[v] != VTK_VOID) found[axis] = true;
        if (!found[0] || !found[1]) throw std::runtime_error("has no variables X and Y with positions");
    }
    bool isRow() const { return zone.cellType == VTK_EMPTY_CELL && zone.size[1] == 1 && zone.size[2] == 1; }
};

/// Adds the arrays one at a time, so that only one of them is in memory twice. Without `read` only notes their units.
void addArrays(const Part& part, bool ofCells, bool read, vtkDataSetAttributes* to, Source& source) {
    const std::vector<std::size_t> variables = part.variables(ofCells);
    for (std::size_t c = 0; c < variables.size(); ++c)
        if (axisOf(part.headings[variables[c]].name) < 0)
            addColumns(part.table(std::span(variables).subspan(c, 1), read), to, source);
}

vtkSmartPointer<vtkPoints> pointsOf(const Part& part) {
    std::vector<double> places[3];
    for (const std::size_t v : part.variables(false))
        if (const int axis = axisOf(part.headings[v].name);
            axis >= 0 && places[axis].empty() && part.zone.types[v] != VTK_VOID) {
            places[axis] = part.values(v);
            if (std::any_of(places[axis].begin(), places[axis].end(), [](double x) { return !std::isfinite(x); }))
                throw std::runtime_error("has a position that is not a number");
        }
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(vtkIdType(part.zone.points));
    for (std::size_t n = 0; n < part.zone.points; ++n)
        points->SetPoint(vtkIdType(n), places[0][n], places[1][n], places[2].empty() ? 0 : places[2][n]);
    return points;
}

/// Tecplot stores wedges, pyramids and tetrahedra as hexahedra with coinciding corners.
void insertBrick(vtkUnstructuredGrid& mesh, const vtkIdType* corners) {
    for (int turn = 0; turn < 8; ++turn) { // the eight rotations of a hexahedron; the last four are upside down
        vtkIdType low[4], high[4];
        for (int n = 0; n < 4; ++n) {
            low[n] = corners[(n + turn) % 4 + (turn < 4 ? 0 : 4)];
            high[n] = corners[(n + turn) % 4 + (turn < 4 ? 4 : 0)];
        }
        std::vector<vtkIdType> base;
        for (int n = 0; n < 4; ++n)
            if (low[n] != low[(n + 1) % 4]) base.push_back(low[n]);
        if (base.size() < 3) continue;
        if (std::count(high, high + 4, high[0]) == 4) {
            base.push_back(high[0]);
            mesh.InsertNextCell(base.size() == 5 ? VTK_PYRAMID : VTK_TETRA, vtkIdType(base.size()), base.data());
            return;
        }
        if (low[2] == low[3] && high[2] == high[3]) {
            const vtkIdType wedge[6] = {low[0], low[1], low[2], high[0], high[1], high[2]};
            mesh.InsertNextCell(VTK_WEDGE, 6, wedge);
            return;
        }
    }
    mesh.InsertNextCell(VTK_HEXAHEDRON, 8, corners);
}

vtkSmartPointer<vtkPointSet> gridOf(const TecplotZone& zone) {
    if (zone.cellType == VTK_EMPTY_CELL) {
        vtkNew<vtkStructuredGrid> grid;
        grid->SetDimensions(int(zone.size[0]), int(zone.size[1]), int(zone.size[2]));
        return grid;
    }
    if (zone.cellType == VTK_POLYHEDRON || zone.cellType == VTK_POLYGON) {
        if (!zone.faces) throw std::runtime_error("has a zone of polyhedra without faces");
        FaceMesh mesh = zone.faces();
        mesh.places.resize(3 * zone.points); // set by the caller
        const FacesOfCells of = facesOfCells(mesh, std::vector<std::uint8_t>(mesh.faces(), 1));
        return cellsOfFaces(mesh, of, 0, mesh.cells, true);
    }
    const std::vector<vtkIdType> corners = zone.corners();
    if (std::any_of(corners.begin(), corners.end(),
                    [&](vtkIdType corner) { return corner < 0 || corner >= vtkIdType(zone.points); }))
        throw std::runtime_error("has a cell with a bad corner");
    vtkNew<vtkUnstructuredGrid> mesh;
    mesh->Allocate(vtkIdType(zone.cells));
    const std::size_t each = cornersOf(zone.cellType);
    for (std::size_t c = 0; c < zone.cells; ++c)
        if (zone.cellType == VTK_HEXAHEDRON)
            insertBrick(*mesh, corners.data() + c * each);
        else
            mesh->InsertNextCell(zone.cellType, vtkIdType(each), corners.data() + c * each);
    return mesh;
}

vtkSmartPointer<vtkDataSet> dataOf(const Part& part, Source& source) {
    part.needPlaces();
    if (part.isRow()) {
        if (!part.variables(true).empty()) throw std::runtime_error("has values of cells in a zone of points");
        return gridOfPoints(part.table(part.variables(false)), source);
    }
    vtkSmartPointer<vtkPointSet> grid = gridOf(part.zone);
    grid->SetPoints(pointsOf(part));
    addArrays(part, false, true, grid->GetPointData(), source);
    addArrays(part, true, true, grid->GetCellData(), source);
    return grid;
}

/// Notes the units. Reads only zones of points, whose coordinates decide how they become a grid.
void noteUnits(const Part& part, Source& source) {
    for (const Heading& heading : part.headings)
        if (axisOf(heading.name) >= 0 && !heading.unit.empty()) source.lengthUnit = heading.unit;
    if (part.isRow()) {
        dataOf(part, source);
        return;
    }
    vtkNew<vtkPointData> none;
    addArrays(part, false, false, none, source);
    addArrays(part, true, false, none, source);
}

/// The zones by time, each with its name and the types of its variables.
struct Frames {
    struct Block {
        std::size_t zone;
        std::string name;
        std::vector<int> types;
    };
    std::vector<Heading> headings;
    std::vector<TecplotZone> zones;
    std::vector<std::vector<Block>> blocks; ///< by time

    Part part(const Block& block) const { return {zones[block.zone], block.types, headings}; }
};

/// The common beginning of two names, in whole words: "air" of "air t=0.5" and "air t=4".
std::string common(const std::string& a, const std::string& b) {
    static constexpr std::string_view kBetween = " _-,;:(";
    const std::size_t same =
        static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
    const auto ends = [same](const std::string& name) {
        return same == name.size() || kBetween.find(name[same]) != std::string_view::npos;
    };
    std::string out = a.substr(0, same);
    if (!ends(a) || !ends(b))
        if (const std::size_t word = out.find_last_of(kBetween); word != std::string::npos) out.resize(word);
    while (!out.empty() && kBetween.find(out.back()) != std::string_view::npos) out.pop_back();
    return out;
}

/// Gives each block one name and one set of variables, even if its name changes over time or a variable has no values
/// at some time.
void sameOverTime(Frames& frames) {
    std::vector<Frames::Block>& first = frames.blocks.front();
    const auto strandOf = [&](const Frames::Block& block) { return frames.zones[block.zone].strand; };
    std::set<int> strands;
    bool known = true; // blocks are identified by strand, or are static
    for (const Frames::Block& block : first)
        known = known && (strandOf(block) ? strands.insert(*strandOf(block)).second
                                          : !frames.zones[block.zone].time.has_value());
    std::vector<std::string> names;
    for (const Frames::Block& block : first) names.push_back(block.name);
    for (const std::vector<Frames::Block>& blocks : frames.blocks) {
        if (blocks.size() != first.size()) return; // reported when that time is read
        known = known && std::ranges::equal(blocks, first, {}, strandOf, strandOf);
        for (std::size_t b = 0; b < first.size(); ++b) names[b] = common(names[b], blocks[b].name);
    }
    if (std::set(names.begin(), names.end()).size() < first.size() || std::ranges::count(names, "") > 0)
        for (std::size_t b = 0; b < first.size(); ++b) names[b] = first[b].name;
    for (std::vector<Frames::Block>& blocks : frames.blocks)
        for (std::size_t b = 0; known && b < first.size(); ++b) blocks[b].name = names[b];
    for (std::size_t b = 0; b < first.size(); ++b)
        for (std::size_t v = 0; v < frames.headings.size(); ++v) {
            std::set<int> types;
            for (const std::vector<Frames::Block>& blocks : frames.blocks) types.insert(blocks[b].types[v]);
            if (types.size() < 2) continue;
            for (std::vector<Frames::Block>& blocks : frames.blocks) blocks[b].types[v] = VTK_FLOAT;
        }
}

/// The box of the points of a zone.
std::array<double, 6> boxOf(const Part& part) {
    std::array<double, 6> box{};
    for (const std::size_t v : part.variables(false)) {
        const int axis = axisOf(part.headings[v].name);
        if (axis < 0 || part.zone.types[v] == VTK_VOID) continue;
        const std::vector<double> places = part.values(v);
        const auto [low, high] = std::ranges::minmax_element(places);
        if (low == places.end()) continue;
        box[std::size_t(2 * axis)] = *low;
        box[std::size_t(2 * axis + 1)] = *high;
    }
    return box;
}

/// The first time, and those at which a block begins, or a zone reaches out of what was seen of its block before.
std::vector<std::size_t> timesToShowOf(const Frames& frames) {
    std::vector<std::size_t> shown;
    std::map<std::string, std::array<double, 6>> seen;
    for (std::size_t t = 0; t < frames.blocks.size(); ++t) {
        bool more = t == 0;
        for (const Frames::Block& block : frames.blocks[t]) {
            const Part part = frames.part(block);
            const bool isNew = !seen.contains(block.name);
            if (frames.blocks.size() < 2 || (part.isRow() && !isNew)) break; // rows become grids when they are read
            const std::array<double, 6> box = boxOf(part);
            std::array<double, 6>& known = seen.try_emplace(block.name, box).first->second;
            more = more || isNew;
            for (std::size_t side = 0; side < 6; ++side) {
                const bool beyond = side % 2 == 0 ? box[side] < known[side] : box[side] > known[side];
                if (beyond) known[side] = box[side];
                more = more || beyond;
            }
        }
        if (more) shown.push_back(t);
    }
    return shown;
}

} // namespace

std::size_t cornersOf(int cellType) {
    switch (cellType) {
    case VTK_HEXAHEDRON:
        return 8;
    case VTK_TETRA:
    case VTK_QUAD:
        return 4;
    case VTK_TRIANGLE:
        return 3;
    case VTK_LINE:
        return 2;
    default:
        return 0;
    }
}

void countOrdered(TecplotZone& zone) {
    double points = 1;
    zone.points = zone.cells = 1;
    for (const std::size_t n : zone.size) {
        points *= double(n);
        if (n > std::size_t(std::numeric_limits<int>::max()) || points > kMostPoints)
            throw std::runtime_error("has a zone with too many points");
        zone.points *= n;
        zone.cells *= std::max<std::size_t>(n, 2) - 1;
    }
}

void giveZones(std::vector<Heading> headings, std::vector<TecplotZone> zones, Source& source) {
    if (zones.empty()) throw std::runtime_error("holds no zone");
    std::set<double> times;
    for (const TecplotZone& zone : zones) {
        if (zone.time && !std::isfinite(*zone.time)) throw std::runtime_error("has a zone with a bad time");
        if (zone.time) times.insert(*zone.time);
    }
    source.times.assign(times.begin(), times.end());
    Frames frames{std::move(headings), std::move(zones), {}};
    for (std::size_t t = 0; t < std::max<std::size_t>(1, times.size()); ++t) {
        std::vector<Frames::Block>& blocks = frames.blocks.emplace_back();
        for (std::size_t z = 0; z < frames.zones.size(); ++z) {
            const TecplotZone& zone = frames.zones[z];
            if (!zone.time || *zone.time == source.times[t]) blocks.push_back({z, zone.name, zone.types});
        }
        std::stable_sort(blocks.begin(), blocks.end(), [&](const Frames::Block& a, const Frames::Block& b) {
            return frames.zones[a.zone].strand < frames.zones[b.zone].strand;
        });
        for (std::size_t b = 0; b < blocks.size(); ++b)
            if (blocks[b].name.empty()) blocks[b].name = "zone " + std::to_string(b + 1);
    }
    if (std::ranges::all_of(frames.blocks, [](const auto& blocks) { return blocks.size() == 1; }))
        for (std::vector<Frames::Block>& blocks : frames.blocks) blocks[0].name.clear();
    sameOverTime(frames);
    for (const Frames::Block& block : frames.blocks.front()) noteUnits(frames.part(block), source);
    source.shownAt = timesToShowOf(frames);
    const auto kept = std::make_shared<const Frames>(std::move(frames));
    source.read = [kept, units = source](std::size_t time) -> vtkSmartPointer<vtkDataObject> {
        Source scratch = units;
        vtkNew<vtkMultiBlockDataSet> out;
        for (const Frames::Block& block : kept->blocks.at(time)) {
            const unsigned b = out->GetNumberOfBlocks();
            out->SetBlock(b, dataOf(kept->part(block), scratch));
            out->GetMetaData(b)->Set(vtkCompositeDataSet::NAME(), block.name);
        }
        return out;
    };
}

} // namespace tessera::importer
