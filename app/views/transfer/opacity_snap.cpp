#include "app/views/transfer/opacity_snap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tessera::app {

namespace {

constexpr double kPeakReach = 0.03; ///< share of the bins over which a peak is the highest
constexpr float kPeakDepth = 0.1f;  ///< of the valleys beside it, as a share of the highest bin

std::optional<double> nearest(double at, const std::vector<double>& lines, double reach) {
    std::optional<double> best;
    for (const double line : lines)
        if (std::abs(line - at) <= reach && (!best || std::abs(line - at) < std::abs(*best - at))) best = line;
    return best;
}

/// Whether the bars fall by `depth` from bin `at` before one rises above it again, to one side.
bool falls(std::span<const float> heights, std::size_t at, int way, float depth) {
    for (auto i = std::ptrdiff_t(at) + way; i >= 0 && i < std::ptrdiff_t(heights.size()); i += way) {
        if (heights[std::size_t(i)] > heights[at]) return false;
        if (heights[std::size_t(i)] <= heights[at] - depth) return true;
    }
    return heights[at] >= depth; // beyond the histogram there is nothing
}

} // namespace

SnapLines snapLines(std::span<const glm::vec2> curve, std::size_t index, std::span<const double> peaks) {
    SnapLines lines{{0, 1}, {0, 1}};
    lines.positions.insert(lines.positions.end(), peaks.begin(), peaks.end());
    if (index > 0 && index <= curve.size()) lines.heights.push_back(double(curve[index - 1].y));
    if (index + 1 < curve.size()) lines.heights.push_back(double(curve[index + 1].y));
    return lines;
}

Snap snapped(glm::dvec2 at, const SnapLines& lines, glm::dvec2 reach) {
    Snap out{at, nearest(at.x, lines.positions, reach.x), nearest(at.y, lines.heights, reach.y)};
    out.at = {out.position.value_or(at.x), out.height.value_or(at.y)};
    return out;
}

std::vector<double> histogramPeaks(std::span<const float> heights) {
    std::vector<double> peaks;
    if (heights.empty()) return peaks;
    const std::size_t reach = std::max<std::size_t>(1, std::size_t(kPeakReach * double(heights.size())));
    const float depth = kPeakDepth * *std::max_element(heights.begin(), heights.end());
    for (std::size_t i = 0; depth > 0 && i < heights.size(); ++i) {
        const std::size_t from = i > reach ? i - reach : 0, to = std::min(heights.size(), i + reach + 1);
        // The first of equally high neighbours is the peak.
        const bool highest = std::all_of(heights.begin() + std::ptrdiff_t(from), heights.begin() + std::ptrdiff_t(i),
                                         [&](float other) { return other < heights[i]; }) &&
                             std::all_of(heights.begin() + std::ptrdiff_t(i), heights.begin() + std::ptrdiff_t(to),
                                         [&](float other) { return other <= heights[i]; });
        if (highest && falls(heights, i, -1, depth) && falls(heights, i, 1, depth))
            peaks.push_back((double(i) + 0.5) / double(heights.size()));
    }
    return peaks;
}

} // namespace tessera::app
