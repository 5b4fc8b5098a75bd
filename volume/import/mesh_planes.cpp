#include "volume/import/mesh_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tessera::volume {

namespace {

constexpr double kCluster = 0.25;     // cells between places that belong together
constexpr double kWidest = 0.35;      // cells, of a plane
constexpr double kStrong = 0.5;       // share of the cross-section that ends at a plane
constexpr double kOneInterval = 1.35; // cells between planes that are one interval
constexpr double kPerCell = 1.5;      // intervals per cell where the mesh has no planes
constexpr double kLeastScale = 0.25;  // of kPerCell, before planes are left out
constexpr double kNoScale = 1e-3;     // of kPerCell, once no more can be left out

/// A plane, and how the stretch from there to the next one is divided.
struct Plane {
    double place = 0, cells = 0; ///< n there
    double strength = 0;
    bool stays = false;    ///< an end of the box or of a region
    bool oneAfter = false; ///< the stretch behind it is one interval, whatever its cells
};

/// n(x) at the places of events, linear between them.
struct CellsUpTo {
    std::vector<double> places, cells;

    double placeOf(double n) const {
        const auto above = std::upper_bound(cells.begin() + 1, cells.end() - 1, n);
        const auto i = std::size_t(above - cells.begin()) - 1;
        const double step = cells[i + 1] - cells[i];
        return step > 0 ? std::lerp(places[i], places[i + 1], std::clamp((n - cells[i]) / step, 0.0, 1.0)) : places[i];
    }
};

CellsUpTo cellsUpTo(const AxisEvents& events) {
    CellsUpTo out;
    double count = 0, perLength = 0, n = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
        out.places.push_back(events[i].place);
        out.cells.push_back(n);
        count += events[i].begun - events[i].ended;
        perLength += events[i].perLengthBegun - events[i].perLengthEnded;
        if (i + 1 == events.size()) break;
        const double length = events[i + 1].place - events[i].place;
        n += count > 0.5 && perLength > 0 ? length * perLength / count : 1; // a gap counts as one cell
    }
    return out;
}

/// The planes of an axis, and whether each cell lies between two of them.
struct StrongPlanes {
    std::vector<Plane> planes;
    bool onlyThere = true;  ///< cells begin and end nowhere else
    bool onePerCell = true; ///< and reach from one to the next
};

/// An end of a region between two places; nothing if there is none.
std::optional<double> endBetween(const std::vector<double>& ends, double lo, double hi) {
    const auto at = std::ranges::lower_bound(ends, lo);
    return at != ends.end() && *at <= hi ? std::optional(*at) : std::nullopt;
}

/// Places where enough cells end together, and the ends of the box and of regions.
StrongPlanes strongPlanes(const AxisEvents& events, const CellsUpTo& upTo, const PlanesOfMesh& mesh, int axis) {
    StrongPlanes out;
    std::vector<Plane>& planes = out.planes;
    const std::vector<double>& ends = mesh.ends[std::size_t(axis)];
    const double slack = 1e-6 * mesh.box.size()[axis]; // two ends of regions so close are one
    double before = 0;                                 // cross-section of the cells at the place
    double count = 0;                                  // of these cells
    for (std::size_t first = 0, next = 0; first < events.size(); first = next) {
        double ended = 0, begun = 0, weight = 0, sum = 0, cellsBegun = 0, cellsEnded = 0;
        std::optional<double> end;
        for (next = first; next < events.size(); ++next) {
            const AxisEvent& event = events[next];
            if (next > first && upTo.cells[next] - upTo.cells[next - 1] > kCluster) break;
            const std::optional<double> own = endBetween(ends, event.place - slack, event.place + slack);
            if (own && end && *own - *end > 2 * slack) break; // a thin region keeps both of its ends
            if (own && !end) end = own;
            ended += event.areaEnded;
            begun += event.areaBegun;
            cellsEnded += event.ended;
            cellsBegun += event.begun;
            const double area = event.areaBegun + event.areaEnded;
            weight += area;
            sum += area * event.place;
        }
        const double width = upTo.cells[next - 1] - upTo.cells[first];
        const double after = std::max(before + begun - ended, 0.0), passing = std::max(before - ended, 0.0);
        Plane plane{.place = end                                  ? *end
                             : next == first + 1 || !(weight > 0) ? events[first].place
                                                                  : sum / weight,
                    .cells = 0.5 * (upTo.cells[next - 1] + upTo.cells[first]),
                    .strength = 1 - passing / std::max({before, after, 1e-300})};
        const bool firstOf = first == 0, lastOf = next == events.size();
        plane.stays = firstOf || lastOf || end;
        if (firstOf) plane.place = mesh.box.lo[axis], plane.cells = upTo.cells.front();
        if (lastOf) plane.place = mesh.box.hi[axis], plane.cells = upTo.cells.back();
        // Every cell there begun here, and none goes on: so it is with each cell between two planes.
        out.onePerCell = out.onePerCell && std::abs(cellsEnded - count) < 0.5;
        before = after;
        count += cellsBegun - cellsEnded;
        out.onePerCell = out.onePerCell && std::abs(cellsBegun - count) < 0.5;
        if ((plane.stays || (plane.strength >= kStrong && width <= kWidest)) &&
            (planes.empty() || plane.place > planes.back().place))
            planes.push_back(plane);
        else
            out.onlyThere = false;
        out.onlyThere = out.onlyThere && width <= kWidest;
    }
    out.onePerCell = out.onePerCell && out.onlyThere;
    // One cluster from end to end: a plane at each end.
    if (planes.size() == 1)
        planes = {{mesh.box.lo[axis], upTo.cells.front(), 1, true}, {mesh.box.hi[axis], upTo.cells.back(), 1, true}};
    return out;
}

double intervalsOf(const Plane& plane, const Plane& next, double scale) {
    const double cells = next.cells - plane.cells;
    if (plane.oneAfter || cells <= kOneInterval) return 1;
    return std::max(1.0, std::ceil(kPerCell * scale * cells - 1e-9));
}

double intervalsOf(const std::vector<Plane>& planes, double scale) {
    double count = 0;
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) count += intervalsOf(planes[i], planes[i + 1], scale);
    return count;
}

/// Leaves out the weakest planes until there are at most so many intervals; returns how many. In rounds, in each of
/// which no two neighbours go.
int leaveOutWeakest(std::vector<Plane>& planes, double most, double scale) {
    int left = 0;
    for (double count = intervalsOf(planes, scale); count > most; count = intervalsOf(planes, scale)) {
        std::vector<std::size_t> weakest;
        for (std::size_t i = 1; i + 1 < planes.size(); ++i)
            if (!planes[i].stays) weakest.push_back(i);
        if (weakest.empty()) break;
        std::ranges::stable_sort(weakest, [&](std::size_t a, std::size_t b) {
            if (planes[a].strength != planes[b].strength) return planes[a].strength < planes[b].strength;
            return planes[a + 1].cells - planes[a - 1].cells < planes[b + 1].cells - planes[b - 1].cells;
        });
        weakest.resize(std::min(weakest.size(), std::size_t(std::max(std::ceil((count - most) / 2), 1.0))));
        std::vector<bool> goes(planes.size());
        for (const std::size_t i : weakest) goes[i] = !goes[i - 1] && !goes[i + 1];
        std::vector<Plane> kept;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            if (!goes[i]) {
                kept.push_back(planes[i]);
                continue;
            }
            kept.back().oneAfter = true;
            ++left;
        }
        planes = std::move(kept);
    }
    return left;
}

AxisPlanes divided(const std::vector<Plane>& planes, const CellsUpTo& upTo, double scale) {
    AxisPlanes out{.planes = {planes.front().place}, .aligned = true};
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
        const int intervals = int(intervalsOf(planes[i], planes[i + 1], scale));
        out.aligned = out.aligned && intervals == 1 && !planes[i].oneAfter;
        const double from = planes[i].cells, to = planes[i + 1].cells;
        for (int k = 1; k <= intervals; ++k) {
            const double place =
                k == intervals ? planes[i + 1].place : upTo.placeOf(std::lerp(from, to, double(k) / intervals));
            if (place > out.planes.back() && (k == intervals || place < planes[i + 1].place))
                out.planes.push_back(place);
        }
    }
    return out;
}

} // namespace

std::array<AxisPlanes, 3> planesOfMesh(const PlanesOfMesh& mesh, std::vector<std::string>& notes) {
    std::array<std::vector<Plane>, 3> planes;
    std::array<AxisPlanes, 3> out;
    std::array<CellsUpTo, 3> upTo;
    std::array<int, 3> leftOut{};
    std::array<double, 3> scale{1, 1, 1};
    const auto counted = [&](int axis) {
        const auto& own = planes[std::size_t(axis)];
        return own.size() < 2 ? 1 : intervalsOf(own, scale[std::size_t(axis)]);
    };
    const auto total = [&] { return counted(0) * counted(1) * counted(2); };
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        if (mesh.events[a].size() < 2) continue;
        upTo[a] = cellsUpTo(mesh.events[a]);
        StrongPlanes strong = strongPlanes(mesh.events[a], upTo[a], mesh, axis);
        out[a].aligned = strong.onlyThere;
        out[a].onePerCell = strong.onePerCell;
        planes[a] = std::move(strong.planes);
        const double most = mesh.mostSamples[axis];
        while (scale[a] > kLeastScale && counted(axis) > most) scale[a] *= 0.95;
        leftOut[a] += leaveOutWeakest(planes[a], most, scale[a]);
        while (scale[a] > kNoScale && counted(axis) > most) scale[a] *= 0.9;
    }
    const auto shrink = [&](double least) {
        while (total() > mesh.mostSamplesOfAll && *std::ranges::max_element(scale) > least)
            for (double& own : scale) own = std::min(own, std::max(own * 0.97, least * 0.999));
    };
    shrink(kLeastScale);
    for (bool found = true; found && total() > mesh.mostSamplesOfAll;) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (counted(axis) > counted(longest)) longest = axis;
        const auto a = std::size_t(longest);
        const int left = leaveOutWeakest(planes[a], std::floor(counted(longest) * 0.95), scale[a]);
        leftOut[a] += left;
        found = left > 0;
    }
    shrink(kNoScale);
    const bool fits = total() <= mesh.mostSamplesOfAll;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        if (planes[a].size() < 2) continue;
        const std::string across = std::string(" across ") + "xyz"[axis];
        if (!fits || counted(axis) > mesh.mostSamples[axis]) {
            out[a] = {};
            notes.push_back("the mesh has too many planes" + across + ": samples lie at even distances");
            continue;
        }
        const AxisPlanes found = divided(planes[a], upTo[a], scale[a]);
        out[a].planes = found.planes;
        out[a].aligned = out[a].aligned && found.aligned;
        out[a].onePerCell = out[a].onePerCell && found.aligned;
        if (leftOut[a] > 0)
            notes.push_back(std::to_string(leftOut[a]) + " planes of the mesh" + across +
                            " lie within samples, since there would be too many");
    }
    return out;
}

AxisEvents joinedEvents(AxisEvents both) {
    std::ranges::sort(both, {}, &AxisEvent::place);
    AxisEvents out;
    for (const AxisEvent& event : both) {
        if (out.empty() || event.place > out.back().place)
            out.push_back(event);
        else
            out.back().add(event);
    }
    return out;
}

AxisEvents eventsOfGrid(const std::vector<double>& borders, double others, double area) {
    AxisEvents events;
    for (std::size_t i = 0; i < borders.size(); ++i) {
        AxisEvent event{.place = borders[i]};
        if (i + 1 < borders.size()) {
            event.begun = others;
            event.areaBegun = area;
            event.perLengthBegun = others / (borders[i + 1] - borders[i]);
        }
        if (i > 0) {
            event.ended = others;
            event.areaEnded = area;
            event.perLengthEnded = others / (borders[i] - borders[i - 1]);
        }
        events.push_back(event);
    }
    return events;
}

} // namespace tessera::volume
