#include "app/tools/brush_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::app {

namespace {

constexpr int kEllipseParts = 64;

/// The plot's x axis is the second of a region in two channels.
template <class Plane> bool swapped(const Plane& plane, const PlotChannels& plot) {
    return plane.x != plot.x;
}
glm::dvec2 turned(glm::dvec2 v, bool swap) {
    return swap ? glm::dvec2(v.y, v.x) : v;
}

/// One side of a new interval: ordered, within the plot.
Range span(double a, double b, Range within) {
    return {std::clamp(std::min(a, b), within.lo, within.hi), std::clamp(std::max(a, b), within.lo, within.hi)};
}

/// An interval moved, or resized at one end.
Range dragged(Range before, double delta, bool lower, bool upper, Range within) {
    const double width = before.hi - before.lo;
    if (!lower && !upper) {
        // Moving keeps the width, so stop at the edge of the plot as a whole.
        const double room = std::max(0.0, (within.hi - within.lo) - width);
        const bool beyond = before.lo < within.lo || before.hi > within.hi;
        const double lo = beyond ? before.lo + delta : std::clamp(before.lo + delta, within.lo, within.lo + room);
        return {lo, lo + width};
    }
    double lo = before.lo, hi = before.hi;
    if (lower) lo = std::clamp(lo + delta, within.lo, within.hi);
    if (upper) hi = std::clamp(hi + delta, within.lo, within.hi);
    return {std::min(lo, hi), std::max(lo, hi)};
}

void dragRange(vis::RangeRegion& now, const vis::RangeRegion& before, int edges, glm::dvec2 delta,
               const PlotFrame& frame, const PlotChannels& plot) {
    for (vis::BrushInterval& interval : now.intervals) {
        const bool isX = interval.channel == plot.x;
        const vis::BrushInterval& own = *intervalOf(before, interval.channel);
        const bool lower = edges & (isX ? kLeftEdge : kBottomEdge), upper = edges & (isX ? kRightEdge : kTopEdge);
        if (edges != 0 && !lower && !upper) continue;
        const Range to = dragged({own.lo, own.hi}, isX ? delta.x : delta.y, lower, upper, isX ? frame.x : frame.y);
        interval.lo = to.lo;
        interval.hi = to.hi;
        if (edges != 0 && own.hi > own.lo) interval.soft = own.soft * (to.hi - to.lo) / (own.hi - own.lo);
    }
}

void dragEllipse(vis::EllipseRegion& now, const vis::EllipseRegion& before, int edges, glm::dvec2 delta,
                 const PlotFrame& frame, const PlotChannels& plot) {
    const bool swap = swapped(before, plot);
    const glm::dvec2 center = turned(before.center, swap), radius = turned(before.radius, swap);
    glm::dvec2 c = center, r = radius;
    for (int axis = 0; axis < 2; ++axis) {
        const bool lower = edges & (axis == 0 ? kLeftEdge : kBottomEdge),
                   upper = edges & (axis == 0 ? kRightEdge : kTopEdge);
        if (edges != 0 && !lower && !upper) continue;
        const Range to = dragged({center[axis] - radius[axis], center[axis] + radius[axis]}, delta[axis], lower, upper,
                                 axis == 0 ? frame.x : frame.y);
        c[axis] = (to.lo + to.hi) / 2;
        // Never flat: its shape divides by the radius.
        r[axis] = std::max((to.hi - to.lo) / 2, 1e-6 * radius[axis]);
    }
    now.center = turned(c, swap);
    now.radius = turned(r, swap);
}

} // namespace

const vis::BrushInterval* intervalOf(const vis::RangeRegion& range, const std::string& channel) {
    for (const vis::BrushInterval& interval : range.intervals)
        if (interval.channel == channel) return &interval;
    return nullptr;
}

BrushRect brushRect(const vis::Region& region, const PlotFrame& frame, const PlotChannels& plot, double soft) {
    if (const auto* range = std::get_if<vis::RangeRegion>(&region)) {
        const vis::BrushInterval* x = intervalOf(*range, plot.x);
        const vis::BrushInterval* y = plot.y.empty() ? nullptr : intervalOf(*range, plot.y);
        const ImVec2 low =
            frame.pixel(x ? x->lo - soft * x->soft : frame.x.lo, y ? y->lo - soft * y->soft : frame.y.lo);
        const ImVec2 high =
            frame.pixel(x ? x->hi + soft * x->soft : frame.x.hi, y ? y->hi + soft * y->soft : frame.y.hi);
        return {{low.x, high.y}, {high.x, low.y}, x == nullptr, y == nullptr};
    }
    const std::vector<ImVec2> outline = brushOutline(region, frame, plot, soft);
    if (outline.empty()) return {{0, 0}, {0, 0}};
    BrushRect rect{outline.front(), outline.front()};
    for (const ImVec2& at : outline) {
        rect.min = {std::min(rect.min.x, at.x), std::min(rect.min.y, at.y)};
        rect.max = {std::max(rect.max.x, at.x), std::max(rect.max.y, at.y)};
    }
    return rect;
}

std::vector<ImVec2> brushOutline(const vis::Region& region, const PlotFrame& frame, const PlotChannels& plot,
                                 double soft) {
    std::vector<ImVec2> outline;
    if (const auto* ellipse = std::get_if<vis::EllipseRegion>(&region)) {
        const bool swap = swapped(*ellipse, plot);
        const double lean = std::sqrt(1 - ellipse->correlation * ellipse->correlation);
        for (int i = 0; i < kEllipseParts; ++i) {
            const double angle = 2 * 3.14159265358979 * i / kEllipseParts;
            // Cholesky: (cos, c cos + sqrt(1 - c^2) sin) lies on the ellipse.
            const glm::dvec2 unit(std::cos(angle), ellipse->correlation * std::cos(angle) + lean * std::sin(angle));
            const glm::dvec2 at = turned(ellipse->center + ellipse->radius * unit * (1 + soft * ellipse->soft), swap);
            outline.push_back(frame.pixel(at.x, at.y));
        }
    }
    if (const auto* lasso = std::get_if<vis::LassoRegion>(&region)) {
        const bool swap = swapped(*lasso, plot);
        if (lasso->points.empty()) return outline;
        // Grown from the middle of its box: not its true soft edge, but a sign of it.
        const vis::LassoPlace place = vis::lassoPlace(*lasso);
        for (const glm::dvec2& point : lasso->points) {
            const glm::dvec2 at = turned(place.center + (point - place.center) * (1 + soft * lasso->soft), swap);
            outline.push_back(frame.pixel(at.x, at.y));
        }
    }
    return outline;
}

bool insideOutline(const std::vector<ImVec2>& outline, ImVec2 at) {
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const ImVec2 a = outline[i], b = outline[j];
        if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)) inside = !inside;
    }
    return inside;
}

void dragRegion(vis::Region& now, const vis::Region& before, int edges, glm::dvec2 delta, const PlotFrame& frame,
                const PlotChannels& plot) {
    if (now.index() != before.index()) return;
    if (auto* range = std::get_if<vis::RangeRegion>(&now))
        dragRange(*range, std::get<vis::RangeRegion>(before), edges, delta, frame, plot);
    if (auto* ellipse = std::get_if<vis::EllipseRegion>(&now))
        dragEllipse(*ellipse, std::get<vis::EllipseRegion>(before), edges, delta, frame, plot);
    if (auto* lasso = std::get_if<vis::LassoRegion>(&now)) {
        const auto& from = std::get<vis::LassoRegion>(before);
        lasso->points = from.points;
        for (glm::dvec2& point : lasso->points) point += turned(delta, swapped(from, plot));
    }
}

void spanRegion(vis::Region& region, glm::dvec2 a, glm::dvec2 b, const PlotFrame& frame, const PlotChannels& plot,
                double softness) {
    if (auto* range = std::get_if<vis::RangeRegion>(&region))
        for (vis::BrushInterval& interval : range->intervals) {
            const bool isX = interval.channel == plot.x;
            const Range to = span(isX ? a.x : a.y, isX ? b.x : b.y, isX ? frame.x : frame.y);
            interval.lo = to.lo;
            interval.hi = to.hi;
            interval.soft = softness * (to.hi - to.lo);
        }
    if (auto* ellipse = std::get_if<vis::EllipseRegion>(&region)) {
        const Range x = span(a.x, b.x, frame.x), y = span(a.y, b.y, frame.y);
        ellipse->center = {(x.lo + x.hi) / 2, (y.lo + y.hi) / 2};
        ellipse->radius = glm::max(glm::dvec2(x.hi - x.lo, y.hi - y.lo) * 0.5,
                                   glm::dvec2(frame.perPixelX(), frame.perPixelY()) * 0.5);
        ellipse->soft = 2 * softness;
    }
}

} // namespace tessera::app
