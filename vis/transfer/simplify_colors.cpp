#include "vis/transfer/simplify_colors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

/// Greatest difference of a component from the line between two stops.
double awayFrom(const ColorStop& a, const ColorStop& b, const ColorStop& stop) {
    const double width = double(b.position) - double(a.position);
    const double along = width > 0 ? (double(stop.position) - double(a.position)) / width : 0;
    const glm::dvec3 off = glm::abs(glm::mix(glm::dvec3(a.color), glm::dvec3(b.color), along) - glm::dvec3(stop.color));
    return std::max({off.r, off.g, off.b});
}

/// Marks what must stay between two stops that do.
void keepBetween(std::span<const ColorStop> stops, std::size_t from, std::size_t to, double tolerance,
                 std::vector<bool>& keep) {
    std::size_t worst = from;
    double most = tolerance;
    for (std::size_t i = from + 1; i < to; ++i)
        if (const double away = awayFrom(stops[from], stops[to], stops[i]); away > most) most = away, worst = i;
    if (worst == from) return;
    keep[worst] = true;
    keepBetween(stops, from, worst, tolerance, keep);
    keepBetween(stops, worst, to, tolerance, keep);
}

} // namespace

std::vector<ColorStop> simplified(std::span<const ColorStop> stops, double tolerance) {
    if (stops.size() < 3) return {stops.begin(), stops.end()};
    std::vector<bool> keep(stops.size(), false);
    keep.front() = keep.back() = true;
    keepBetween(stops, 0, stops.size() - 1, tolerance, keep);
    std::vector<ColorStop> out;
    for (std::size_t i = 0; i < stops.size(); ++i)
        if (keep[i]) out.push_back(stops[i]);
    return out;
}

} // namespace tessera::vis
