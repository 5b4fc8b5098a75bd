#include "volume/field/axis_map.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tessera::volume {

namespace {

/// The interval between two knots that a place lies in, 0 to knots - 2; places beyond the ends are of the end
/// intervals.
std::size_t intervalOf(const std::vector<double>& knots, double place) {
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, place);
    return std::size_t(above - knots.begin()) - 1;
}

} // namespace

AxisMap::AxisMap(Of of, std::vector<double> planes) : of_(of), planes_(std::move(planes)) {
    if (planes_.size() < 2) throw Error("an axis has at least two planes");
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (!std::isfinite(planes_[i])) throw Error("plane " + std::to_string(i) + " of the axis is not finite");
        if (i > 0 && !(planes_[i] > planes_[i - 1]))
            throw Error("the planes of the axis do not rise from " + std::to_string(i - 1) + " to " +
                        std::to_string(i));
    }
    if (!std::isfinite(hi() - lo())) throw Error("the planes of the axis are too far apart");
}

double AxisMap::toSpace(double sheet) const {
    const double cells = (sheet - lo()) / spacing();
    const double last = double(planes_.size() - 2);
    const double i = cells > 0 ? std::min(std::floor(cells), last) : 0; // also where the place is no number
    const double a = planes_[std::size_t(i)], b = planes_[std::size_t(i) + 1];
    return cells - i == 1 ? b : a + (cells - i) * (b - a);
}

double AxisMap::toSheet(double place) const {
    const std::size_t i = intervalOf(planes_, place);
    const double cells = double(i) + (place - planes_[i]) / (planes_[i + 1] - planes_[i]);
    return lo() + cells * spacing();
}

double AxisMap::between(double place) const {
    if (of_ == Of::Points || samples() < 2) return (toSheet(place) - origin()) / spacing();
    // The cell of the place, then the two samples around it.
    const int cell = int(intervalOf(planes_, place));
    const int i = std::clamp(place < sample(cell) ? cell - 1 : cell, 0, samples() - 2);
    const double a = sample(i), b = sample(i + 1);
    return i + (place - a) / (b - a);
}

double AxisMap::sample(int i) const {
    const auto at = std::size_t(i);
    return of_ == Of::Points ? planes_[at] : 0.5 * (planes_[at] + planes_[at + 1]);
}

double AxisMap::border(int i) const {
    if (of_ == Of::Cells) return planes_[std::size_t(i)];
    if (i == 0 || i == samples()) return i == 0 ? lo() : hi();
    return 0.5 * (planes_[std::size_t(i) - 1] + planes_[std::size_t(i)]);
}

bool AxisMaps::operator==(const AxisMaps& other) const {
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap *a = (*this)[axis], *b = other[axis];
        if (a != b && (!a || !b || !(*a == *b))) return false;
    }
    return true;
}

} // namespace tessera::volume
