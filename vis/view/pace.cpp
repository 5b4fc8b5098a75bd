#include "vis/view/pace.h"

#include <algorithm>
#include <iterator>

namespace tessera::vis {

bool Pace::beginCall() {
    constexpr std::size_t kMostBehind = 8; // draws whose time is not known yet
    given_ = 0;
    collect(false);
    return timer_.pending() <= kMostBehind;
}

bool Pace::fits(double area, double left) const {
    if (!timer_.queries()) return left > 0;
    return known() && given_ + expected(area) < left;
}

Pace::Reduction Pace::reduction(double area, double budget, bool geometry) const {
    static constexpr Reduction kReductions[] = {{1.0, 1.0}, {1.5, 1.5}, {2.0, 2.0}, {3.0, 2.0},
                                                {4.0, 2.0}, {6.0, 2.0}, {8.0, 3.0}, {8.0, 5.0}};
    // No smaller than the last entry: below, all pixels would fall into a few tiles of software GL, and cores would be
    // idle.
    if (!known()) return {};
    const double before = geometry ? geometry_ : 0;
    for (const Reduction& each : kReductions)
        if (before + expected(area) / (each.shrink * each.shrink * each.stepFactor) < budget) return each;
    return kReductions[std::size(kReductions) - 1];
}

/// A time too short for the driver's clock is known all the same.
void Pace::learn(double perPixel) {
    constexpr double kLeast = 1e-12;
    perPixel_ = std::max(known() ? 0.5 * (perPixel_ + perPixel) : perPixel, kLeast);
}

void Pace::timeGeometry(const std::function<void()>& draw) {
    given_ += geometry_;
    timer_.measure(draw, [this](double milliseconds) { geometry_ = milliseconds; });
}

void Pace::timeReduced(const std::function<void()>& draw, double stepFactor, double area) {
    given_ += expected(area) / stepFactor;
    timer_.measure(draw, [this, stepFactor, area](double milliseconds) {
        learn(milliseconds * stepFactor / std::max(1.0, area));
    });
}

void Pace::beginPass(bool wait, double budget) {
    constexpr int kLargest = 128, kSmallest = 32, kWaiting = 1024;
    ++passNumber_;
    pass_ = measured_ = area_ = 0;
    scale_ = 1;
    // Never the whole picture: the cost of a coarse picture predicts that of the full one poorly.
    tileEdge_ = wait ? kWaiting : kLargest;
    const double perTile = wait ? 1e9 : std::max(budget / 3, 2.0);
    while (tileEdge_ > kSmallest && expected(double(tileEdge_) * tileEdge_) > perTile) tileEdge_ /= 2;
}

void Pace::timeTile(const std::function<void()>& draw, double area, bool counts) {
    given_ += expected(area);
    timer_.measure(draw, [this, area, number = counts ? passNumber_ : 0](double milliseconds) {
        tookTile(milliseconds, area, number);
    });
}

void Pace::tookTile(double milliseconds, double area, int pass) {
    if (pass != passNumber_) return;
    pass_ += milliseconds;
    measured_ += area;
    if (!known() && timer_.queries()) learn(milliseconds / std::max(1.0, area));
    settle();
}

void Pace::finishPass(double area, double whole) {
    area_ = std::max(1.0, area);
    scale_ = whole / area_;
    settle();
}

/// After a complete pass, its cost per pixel predicts the next one.
void Pace::settle() {
    if (area_ > 0 && measured_ >= area_) perPixel_ = pass_ / area_;
}

} // namespace tessera::vis
