#include "volume/field/own_axes.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

/// Of a lattice whose cells are those of the map from one of its samples on: the number of that sample.
int firstOf(const Lattice& cc, int axis) {
    const AxisMap& map = *cc.axes[axis];
    const double first = (cc.origin[axis] - map.origin()) / map.spacing(), whole = std::round(first);
    constexpr double kSame = 1e-6; // of a cell
    const bool same = std::abs(cc.spacing[axis] - map.spacing()) * cc.size[axis] <= kSame * map.spacing() &&
                      std::abs(first - whole) <= kSame;
    return same && whole >= 0 && whole + cc.size[axis] <= map.samples() ? int(whole) : -1;
}

} // namespace

Lattice withOwnAxes(const Lattice& cc) {
    AxisMaps own = cc.axes;
    Lattice out = cc;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap* map = cc.axes[axis];
        if (!map) continue;
        const int first = firstOf(cc, axis), n = cc.size[axis];
        if (first == 0 && n == map->samples()) continue;
        auto& mine = own.of[std::size_t(axis)];
        if (first >= 0 && (map->of() == AxisMap::Of::Cells || n > 1)) {
            const auto begin = map->planes().begin() + first;
            const int planes = n + (map->of() == AxisMap::Of::Cells ? 1 : 0);
            mine = std::make_shared<const AxisMap>(map->of(), std::vector(begin, begin + planes));
        } else if (n > 1) {
            mine = std::make_shared<const AxisMap>(AxisMap::Of::Points, samplePlaces(cc)[std::size_t(axis)]);
        } else { // one sample has no distance to others
            const double half = 0.5 * cc.spacing[axis], at = cc.origin[axis];
            mine = nullptr;
            out.origin[axis] = map->toSpace(at);
            out.spacing[axis] = map->toSpace(at + half) - map->toSpace(at - half);
        }
    }
    return own == cc.axes ? cc : withAxes(out, own);
}

bool hasCells(const AxisMaps& axes) {
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) any = any || (axes[axis] && axes[axis]->of() == AxisMap::Of::Cells);
    return any;
}

Box gridBounds(const Lattice& cc) {
    Box box{cc.sheetPosition({0, 0, 0}), cc.sheetPosition(cc.size - 1)};
    const double beyond = hasCells(cc.axes) ? 0.5 : 0;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap* map = cc.axes[axis];
        box.lo[axis] = map ? map->lo() : box.lo[axis] - beyond * cc.spacing[axis];
        box.hi[axis] = map ? map->hi() : box.hi[axis] + beyond * cc.spacing[axis];
    }
    return box;
}

bool samePlanes(const AxisMap* a, const AxisMap* b, double share) {
    if (!a || !b) return a == b;
    const std::vector<double>&of = a->planes(), &other = b->planes();
    if (a->of() != b->of() || of.size() != other.size()) return false;
    for (std::size_t i = 0; i < of.size(); ++i) {
        const double below = i > 0 ? of[i] - of[i - 1] : of[1] - of[0],
                     above = i + 1 < of.size() ? of[i + 1] - of[i] : below;
        if (!(std::abs(of[i] - other[i]) <= share * std::min(below, above))) return false;
    }
    return true;
}

std::array<std::vector<double>, 3> samplePlaces(const Lattice& cc) {
    std::array<std::vector<double>, 3> places;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& along = places[std::size_t(axis)];
        const int first = cc.axes[axis] ? firstOf(cc, axis) : -1;
        for (int i = 0; i < cc.size[axis]; ++i) {
            glm::ivec3 at(0);
            at[axis] = i;
            along.push_back(first >= 0 ? cc.axes[axis]->sample(first + i) : cc.position(at)[axis]);
        }
    }
    return places;
}

CellLengths cellLengthsAlong(const Lattice& lattice, int axis) {
    const AxisMap* map = lattice.axes[axis];
    if (!map) return {lattice.spacing[axis], lattice.spacing[axis]};
    const std::vector<double>& planes = map->planes();
    CellLengths lengths{planes[1] - planes[0], planes[1] - planes[0]};
    for (std::size_t i = 1; i < planes.size(); ++i) {
        lengths.least = std::min(lengths.least, planes[i] - planes[i - 1]);
        lengths.greatest = std::max(lengths.greatest, planes[i] - planes[i - 1]);
    }
    return lengths;
}

} // namespace tessera::volume
