#include "app/importer/mesh_events.h"

#include "app/importer/present_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>
#include <vector>
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
    event.begun += other.begun;
    event.ended += other.ended;
    event.areaBegun += other.areaBegun;
    event.areaEnded += other.areaEnded;
    event.perLengthBegun += other.perLengthBegun;
    event.perLengthEnded += other.perLengthEnded;
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
    block.box = {lo, hi};
    block.cellSize = glm::dvec3(block.cells) / inverse;
    for (std::size_t axis = 0; axis < 3; ++axis) block.events[axis] = collected[axis].atMost(most);
}

} // namespace tessera::importer
