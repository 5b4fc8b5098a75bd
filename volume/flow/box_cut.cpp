#include "volume/flow/box_cut.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

BoxCut::BoxCut(glm::dvec3 normal, glm::dvec3 lo, glm::dvec3 hi) {
    constexpr double kNone = 1e-4;
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(normal[axis]) * (hi[axis] - lo[axis]));
    double middle = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double share = std::abs(normal[axis]), edge = hi[axis] - lo[axis];
        whole_ *= edge;
        middle += normal[axis] * 0.5 * (lo[axis] + hi[axis]);
        if (share * edge < kNone * largest) {
            scale_ *= edge;
            continue;
        }
        edges_[axes_++] = share * edge;
        scale_ /= share;
        reach += 0.5 * share * edge;
    }
    first_ = middle - reach;
    last_ = middle + reach;
}

double BoxCut::sum(double s, int power) const {
    double out = 0, factorial = 1;
    for (int i = 2; i <= power; ++i) factorial *= i;
    for (unsigned corner = 0; corner < 1u << axes_; ++corner) {
        double beyond = s;
        bool even = true;
        for (int axis = 0; axis < axes_; ++axis)
            if ((corner >> axis & 1) != 0) {
                beyond -= edges_[axis];
                even = !even;
            }
        if (beyond <= 0) continue;
        double term = 1;
        for (int i = 0; i < power; ++i) term *= beyond;
        out += even ? term : -term;
    }
    return scale_ * out / factorial;
}

double BoxCut::volume(double s) const {
    if (s <= first_) return 0;
    if (s >= last_) return whole_;
    // Compute from the nearer end, where the sum has the most digits; a box is symmetric.
    const bool near = s - first_ < last_ - s;
    const double part = std::clamp(sum(near ? s - first_ : last_ - s, axes_), 0.0, whole_);
    return near ? part : whole_ - part;
}

double BoxCut::area(double s) const {
    if (s < first_ || s >= last_) return 0;
    return std::max(sum(std::min(s - first_, last_ - s), axes_ - 1), 0.0);
}

} // namespace tessera::volume
