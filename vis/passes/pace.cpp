#include "vis/passes/pace.h"

#include <algorithm>
#include <iterator>

namespace tessera::vis {

Pace::Reduction Pace::reduction(double area, double budget) const {
    // Not smaller than the last: two processors would share one tile of software GL.
    static constexpr Reduction kReductions[] = {{1.0, 1.0}, {1.5, 1.5}, {2.0, 2.0}, {3.0, 2.0},
                                                {4.0, 2.0}, {6.0, 2.0}, {8.0, 3.0}, {8.0, 5.0}};
    if (!known()) return {};
    for (const Reduction& each : kReductions)
        if (geometry_ + expected(area) / (each.shrink * each.shrink * each.stepFactor) < budget) return each;
    return kReductions[std::size(kReductions) - 1];
}

void Pace::tookReduced(double geometry, double rays, double stepFactor, double area) {
    geometry_ = geometry;
    const double cost = rays * stepFactor / std::max(1.0, area);
    perPixel_ = known() ? 0.5 * (perPixel_ + cost) : cost;
}

void Pace::beginPass(bool wait, double budget) {
    constexpr int kLargest = 128, kSmallest = 32, kWaiting = 1024;
    pass_ = 0;
    // Never the whole: what a coarse picture cost says little of the fine one.
    tileEdge_ = wait ? kWaiting : kLargest;
    const double perTile = wait ? 1e9 : std::max(budget / 3, 2.0);
    while (tileEdge_ > kSmallest && expected(double(tileEdge_) * tileEdge_) > perTile) tileEdge_ /= 2;
}

void Pace::finishPass(double area, double whole) {
    perPixel_ = pass_ / std::max(1.0, area);
    pass_ *= whole / std::max(1.0, area);
}

} // namespace tessera::vis
