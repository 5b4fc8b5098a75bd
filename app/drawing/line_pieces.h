#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

/// Lines cut at the edge of an area, and into dashes.
namespace tessera::app {

/// The parts of a line of points that lie in a convex polygon, whichever way its corners run; none for fewer than three
/// corners.
std::vector<std::vector<glm::dvec2>> piecesWithin(const std::vector<glm::dvec2>& line,
                                                  const std::vector<glm::dvec2>& polygon);

/// Joined lines as dashes: each begins a period after the one before, also around corners.
class DashPattern {
public:
    DashPattern(double dash, double period) : dash_(dash), period_(period) {}

    /// Calls `each(from, to)` for the dashes of the next line.
    template <class Each> void line(glm::dvec2 from, glm::dvec2 to, Each&& each) {
        const double length = glm::distance(from, to);
        if (!(length > 0)) return;
        const auto at = [&](double way) { return from + (to - from) * (way / length); };
        for (double way = 0; way < length;) {
            const double within = std::fmod(phase_ + way, period_);
            const double end = std::min(length, way + (within < dash_ ? dash_ : period_) - within + 1e-3 * period_);
            if (within < dash_) each(at(way), at(end));
            way = end;
        }
        phase_ = std::fmod(phase_ + length, period_);
    }

private:
    double dash_, period_, phase_ = 0;
};

} // namespace tessera::app
