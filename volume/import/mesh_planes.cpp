#include "volume/import/mesh_planes.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

constexpr double kCluster = 0.25;     // cells between places that belong together
constexpr double kWidest = 0.35;      // cells, of a plane
constexpr double kStrong = 0.5;       // share of the cross-section that ends at a plane
constexpr double kOneInterval = 1.35; // cells between planes that are one interval
constexpr double kPerCell = 1.5;      // intervals per cell where the mesh has no planes
constexpr double kLeastScale = 0.25;  // of kPerCell, before planes are left out

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

/// Places where enough cells end together, and the ends.
StrongPlanes strongPlanes(const AxisEvents& events, const CellsUpTo& upTo, const Box& box,
                          const std::vector<Box>& regions, int axis) {
    StrongPlanes out;
    std::vector<Plane>& planes = out.planes;
    double before = 0;                      // cross-section of the cells at the place
    double count = 0, all = 0, covered = 0; // cells there; of all; intervals that they cover
    for (std::size_t first = 0, next = 0; first < events.size(); first = next) {
        double ended = 0, begun = 0, weight = 0, sum = 0;
        for (next = first; next < events.size(); ++next) {
            if (next > first && upTo.cells[next] - upTo.cells[next - 1] > kCluster) break;
            const AxisEvent& event = events[next];
            ended += event.areaEnded;
            begun += event.areaBegun;
            count += event.begun - event.ended;
            all += event.begun;
            const double own = event.areaBegun + event.areaEnded;
            weight += own;
            sum += own * event.place;
        }
        const double width = upTo.cells[next - 1] - upTo.cells[first];
        const double after = std::max(before + begun - ended, 0.0), passing = std::max(before - ended, 0.0);
        Plane plane{.place = next == first + 1 || !(weight > 0) ? events[first].place : sum / weight,
                    .cells = 0.5 * (upTo.cells[next - 1] + upTo.cells[first]),
                    .strength = 1 - passing / std::max({before, after, 1e-300})};
        const double lo = events[first].place, hi = events[next - 1].place, slack = 1e-9 * box.size()[axis];
        const bool firstOf = first == 0, lastOf = next == events.size();
        bool endOfRegion = false;
        for (const Box& region : regions)
            for (const double end : {region.lo[axis], region.hi[axis]})
                if (end >= lo - slack && end <= hi + slack) endOfRegion = true;
        plane.stays = firstOf || lastOf || endOfRegion;
        if (firstOf) plane.place = box.lo[axis], plane.cells = upTo.cells.front();
        if (lastOf) plane.place = box.hi[axis], plane.cells = upTo.cells.back();
        before = after;
        if (!lastOf) covered += count;
        if (plane.stays || (plane.strength >= kStrong && width <= kWidest))
            planes.push_back(plane);
        else
            out.onlyThere = false;
        out.onlyThere = out.onlyThere && width <= kWidest;
    }
    out.onePerCell = out.onlyThere && std::abs(covered - all) < 0.5;
    // One cluster from end to end: a plane at each end.
    if (planes.size() == 1)
        planes = {{box.lo[axis], upTo.cells.front(), 1, true}, {box.hi[axis], upTo.cells.back(), 1, true}};
    return out;
}

int intervalsOf(const Plane& plane, const Plane& next, double scale) {
    const double cells = next.cells - plane.cells;
    if (plane.oneAfter || cells <= kOneInterval) return 1;
    return std::max(1, int(std::ceil(kPerCell * scale * cells - 1e-9)));
}

int intervalsOf(const std::vector<Plane>& planes, double scale) {
    int count = 0;
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) count += intervalsOf(planes[i], planes[i + 1], scale);
    return count;
}

/// Leaves out the weakest planes until there are at most so many intervals; returns how many.
int leaveOutWeakest(std::vector<Plane>& planes, int most, double scale) {
    int left = 0;
    for (int count = intervalsOf(planes, scale); count > most; count = intervalsOf(planes, scale)) {
        std::size_t weakest = 0;
        const auto isWeaker = [&](std::size_t a, std::size_t b) { // a than b
            if (planes[a].strength != planes[b].strength) return planes[a].strength < planes[b].strength;
            return planes[a + 1].cells - planes[a - 1].cells < planes[b + 1].cells - planes[b - 1].cells;
        };
        for (std::size_t i = 1; i + 1 < planes.size(); ++i)
            if (!planes[i].stays && (weakest == 0 || isWeaker(i, weakest))) weakest = i;
        if (weakest == 0) break;
        planes[weakest - 1].oneAfter = true;
        planes.erase(planes.begin() + std::ptrdiff_t(weakest));
        ++left;
    }
    return left;
}

AxisPlanes divided(const std::vector<Plane>& planes, const CellsUpTo& upTo, double scale) {
    AxisPlanes out{.planes = {planes.front().place}, .aligned = true};
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
        const int intervals = intervalsOf(planes[i], planes[i + 1], scale);
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
    const auto total = [&] { return double(counted(0)) * counted(1) * counted(2); };
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = std::size_t(axis);
        if (mesh.events[a].size() < 2) continue;
        upTo[a] = cellsUpTo(mesh.events[a]);
        StrongPlanes strong = strongPlanes(mesh.events[a], upTo[a], mesh.box, mesh.regions, axis);
        out[a].aligned = strong.onlyThere;
        out[a].onePerCell = strong.onePerCell;
        planes[a] = std::move(strong.planes);
        while (scale[a] > kLeastScale && counted(axis) > mesh.mostSamples[axis]) scale[a] *= 0.95;
        leftOut[a] += leaveOutWeakest(planes[a], int(mesh.mostSamples[axis]), scale[a]);
    }
    while (total() > mesh.mostSamplesOfAll && *std::ranges::max_element(scale) > kLeastScale)
        for (double& own : scale) own = std::max(own * 0.97, kLeastScale * 0.999);
    for (int round = 0; round < 1000 && total() > mesh.mostSamplesOfAll; ++round) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (counted(axis) > counted(longest)) longest = axis;
        const auto a = std::size_t(longest);
        const int left = leaveOutWeakest(planes[a], counted(longest) * 19 / 20, scale[a]);
        if (left == 0) break;
        leftOut[a] += left;
    }
    for (std::size_t a = 0; a < 3; ++a) {
        if (planes[a].size() < 2) continue;
        const AxisPlanes found = divided(planes[a], upTo[a], scale[a]);
        out[a].planes = found.planes;
        out[a].aligned = out[a].aligned && found.aligned;
        out[a].onePerCell = out[a].onePerCell && found.aligned;
        if (leftOut[a] > 0)
            notes.push_back(std::to_string(leftOut[a]) + " planes of the mesh across " + "xyz"[a] +
                            " lie within samples, since there would be too many");
    }
    return out;
}

AxisEvents joinedEvents(const AxisEvents& a, const AxisEvents& b) {
    AxisEvents both = a;
    both.insert(both.end(), b.begin(), b.end());
    std::ranges::sort(both, {}, &AxisEvent::place);
    AxisEvents out;
    for (const AxisEvent& event : both) {
        if (out.empty() || event.place > out.back().place) {
            out.push_back(event);
            continue;
        }
        AxisEvent& into = out.back();
        into.begun += event.begun;
        into.ended += event.ended;
        into.areaBegun += event.areaBegun;
        into.areaEnded += event.areaEnded;
        into.perLengthBegun += event.perLengthBegun;
        into.perLengthEnded += event.perLengthEnded;
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
