#include "app/importer/mesh_events.h"

#include "app/importer/present_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace {

using volume::AxisEvent;
using volume::AxisEvents;

constexpr double kSamePlace = 0.02; // cells

double weightOf(const AxisEvent& event) {
    return event.areaBegun + event.areaEnded;
}

/// Adds `other`, which lies beside it; the place is that of the larger cross-section.
void join(AxisEvent& event, const AxisEvent& other) {
    if (weightOf(other) > weightOf(event)) event.place = other.place;
    event.add(other);
}

/// Mean extent of the cells of an event.
double extentOf(const AxisEvent& event) {
    const double perLength = event.perLengthBegun + event.perLengthEnded;
    return perLength > 0 ? (event.begun + event.ended) / perLength : 0;
}

/// Joins neighbours that are closer than a share of the cells there.
AxisEvents merged(const AxisEvents& sorted, double share) {
    AxisEvents out;
    double first = 0;
    for (const AxisEvent& event : sorted) {
        const double apart = out.empty() ? 0 : event.place - first;
        const bool same = !out.empty() && (event.place == out.back().place ||
                                           apart < share * std::min(extentOf(out.back()), extentOf(event)));
        if (same) {
            join(out.back(), event);
            continue;
        }
        out.push_back(event);
        first = event.place;
    }
    return out;
}

void sortAndMerge(AxisEvents& events, double share) {
    std::ranges::sort(events, {}, &AxisEvent::place);
    events = merged(events, share);
}

/// Collects the events of one axis; what repeats is joined now and then, so that memory stays small.
struct Collected {
    AxisEvents events;
    std::size_t enough = std::size_t(1) << 16;

    void add(const AxisEvent& event) {
        events.push_back(event);
        if (events.size() < enough) return;
        std::ranges::sort(events, {}, &AxisEvent::place);
        events = merged(events, 1e-7);
        enough = std::max(enough, 2 * events.size());
    }
    AxisEvents atMost(std::size_t most) {
        double share = kSamePlace;
        sortAndMerge(events, share);
        while (events.size() > most && share < 1) sortAndMerge(events, share *= 1.5);
        return events.size() > most ? AxisEvents{} : std::move(events);
    }
};

/// Volume of a cell with flat or slightly bent faces, as tetrahedra; nothing for polyhedra and curved cells.
std::optional<double> volumeOf(vtkDataSet* mesh, vtkIdType cell, vtkIdList* points) {
    using Tetrahedron = std::array<int, 4>;
    static constexpr Tetrahedron kTetra[] = {{0, 1, 2, 3}}, kPyramid[] = {{0, 1, 2, 4}, {0, 2, 3, 4}},
                                 kWedge[] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}};
    static constexpr Tetrahedron kHexahedron[] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                                  {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    static constexpr Tetrahedron kVoxel[] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                             {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    std::span<const Tetrahedron> parts;
    switch (mesh->GetCellType(cell)) {
    case VTK_TETRA:
        parts = kTetra;
        break;
    case VTK_PYRAMID:
        parts = kPyramid;
        break;
    case VTK_WEDGE:
        parts = kWedge;
        break;
    case VTK_HEXAHEDRON:
        parts = kHexahedron;
        break;
    case VTK_VOXEL:
        parts = kVoxel;
        break;
    default:
        return std::nullopt;
    }
    mesh->GetCellPoints(cell, points);
    const auto corner = [&](int i) {
        double place[3];
        mesh->GetPoint(points->GetId(i), place);
        return glm::dvec3(place[0], place[1], place[2]);
    };
    double volume = 0;
    for (const Tetrahedron& part : parts) {
        const glm::dvec3 from = corner(part[0]);
        volume +=
            std::abs(glm::dot(corner(part[1]) - from, glm::cross(corner(part[2]) - from, corner(part[3]) - from)));
    }
    return volume / 6;
}

/// Whether a cell is a box along the axes, to 1e-3 of its edges.
bool isBox(vtkDataSet* mesh, vtkIdType cell, const glm::dvec3& lo, const glm::dvec3& hi, vtkIdList* points) {
    mesh->GetCellPoints(cell, points);
    if (points->GetNumberOfIds() != 8) return false;
    int corners = 0; // a bit for each corner of the box
    for (vtkIdType i = 0; i < 8; ++i) {
        double place[3];
        mesh->GetPoint(points->GetId(i), place);
        int corner = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double share = (place[axis] - lo[axis]) / (hi[axis] - lo[axis]);
            if (!(std::abs(share - std::round(share)) <= 1e-3)) return false;
            corner |= share > 0.5 ? 1 << axis : 0;
        }
        corners |= 1 << corner;
    }
    return corners == 0xff;
}

} // namespace

void describeCells(vtkDataSet* mesh, std::size_t most, volume::FileBlock& block) {
    const double* all = mesh->GetBounds();
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, all[2 * axis + 1] - all[2 * axis]);
    const std::vector<std::uint8_t> present = presentCells(mesh);
    glm::dvec3 inverse(0), lo(std::numeric_limits<double>::max()), hi(std::numeric_limits<double>::lowest());
    std::array<Collected, 3> collected;
    block.cells = 0;
    block.boxes = true;
    block.volume = 0;
    bool hasVolume = true;
    vtkNew<vtkIdList> points;
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c) {
        if (!volume::isPresent(present, std::size_t(c))) continue;
        double bounds[6];
        mesh->GetCellBounds(c, bounds);
        const glm::dvec3 least(bounds[0], bounds[2], bounds[4]), most3(bounds[1], bounds[3], bounds[5]);
        lo = glm::min(lo, least);
        hi = glm::max(hi, most3);
        const glm::dvec3 extent = glm::max(most3 - least, 1e-7 * largest);
        inverse += 1.0 / extent;
        ++block.cells;
        const std::optional<double> volume = volumeOf(mesh, c, points);
        hasVolume = hasVolume && volume;
        block.volume += volume.value_or(0);
        block.boxes = block.boxes && isBox(mesh, c, least, most3, points);
        for (int axis = 0; axis < 3; ++axis) {
            const double area = extent[(axis + 1) % 3] * extent[(axis + 2) % 3], perLength = 1 / extent[axis];
            if (!std::isfinite(area + perLength) || !(most3[axis] > least[axis])) continue;
            auto& events = collected[std::size_t(axis)];
            events.add({least[axis], 1, 0, area, 0, perLength, 0});
            events.add({most3[axis], 0, 1, 0, area, 0, perLength});
        }
    }
    if (block.cells < 1) throw std::runtime_error("holds no cells that are data, only ghosts of other pieces");
    if (!hasVolume) block.volume = 0;
    block.box = {lo, hi};
    block.cellSize = glm::dvec3(block.cells) / inverse;
    for (std::size_t axis = 0; axis < 3; ++axis) block.events[axis] = collected[axis].atMost(most);
}

} // namespace tessera::importer
