#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

/// Where points of an opacity curve catch while they are dragged: a point slightly above the axis would haze all that
/// should be clear.
namespace tessera::app {

/// Positions and heights, 0..1 each, that a point takes when it comes near.
struct SnapLines {
    std::vector<double> positions, heights;
};

/// Those of point `index` of a curve: the ends of the range and `peaks`, as positions; 0, 1 and the neighbours'
/// heights.
SnapLines snapLines(std::span<const glm::vec2> curve, std::size_t index, std::span<const double> peaks);

/// A place that was caught, and the lines that caught it.
struct Snap {
    glm::dvec2 at;
    std::optional<double> position, height;
    bool operator==(const Snap&) const = default;
};

/// The nearest position and the nearest height within `reach` (0..1 along each axis), independently; of equally near
/// ones the first.
Snap snapped(glm::dvec2 at, const SnapLines& lines, glm::dvec2 reach);

/// Middles of the peaks of a histogram as positions 0..1, lowest first: bins that stand above all within 3 % of the
/// bins and, on both sides, above a valley by a tenth of the highest bin. `heights`: of the bars, as they are shown.
std::vector<double> histogramPeaks(std::span<const float> heights);

} // namespace tessera::app
