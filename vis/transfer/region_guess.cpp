#include "vis/transfer/region_guess.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera::vis {

namespace {

constexpr double kBelowTop = 0.9995;          ///< share of the strength below the top of the plane
constexpr double kTopRoom = 1.15;             ///< of the top above that
constexpr double kLowest = 0.1, kMost = 0.99; ///< shares of the strength below the edges of the region
constexpr int kSmoothBins = 4;                ///< on either side: scans do not have every value
constexpr int kShownGradients = 32;

/// Strength of value v's gradients in bin g.
double strength(const volume::DerivativeHistogram& histogram, int v, int g) {
    const double gradient = (g + 0.5) / histogram.gradientBins;
    return double(histogram.count[std::size_t(g) * std::size_t(histogram.valueBins) + std::size_t(v)]) * gradient *
           gradient * gradient;
}

/// The gradient, 0..1 up to the histogram's top, below which a share of the strength of some values lies.
double gradientBelow(const volume::DerivativeHistogram& histogram, int from, int to, double share) {
    std::vector<double> sums(std::size_t(histogram.gradientBins), 0);
    double all = 0;
    for (int g = 0; g < histogram.gradientBins; ++g)
        for (int v = from; v < to; ++v) {
            sums[std::size_t(g)] += strength(histogram, v, g);
            all += strength(histogram, v, g);
        }
    double below = 0;
    for (int g = 0; g < histogram.gradientBins; ++g)
        if ((below += sums[std::size_t(g)]) >= share * all) return double(g + 1) / histogram.gradientBins;
    return 1;
}

/// Strength by value, smoothed by a triangle.
std::vector<double> strengths(const volume::DerivativeHistogram& histogram) {
    const int bins = histogram.valueBins;
    std::vector<double> sharp(std::size_t(bins), 0), out(std::size_t(bins), 0);
    for (int v = 0; v < bins; ++v)
        for (int g = 0; g < histogram.gradientBins; ++g) sharp[std::size_t(v)] += strength(histogram, v, g);
    for (int v = 0; v < bins; ++v)
        for (int near = std::max(v - kSmoothBins, 0); near <= std::min(v + kSmoothBins, bins - 1); ++near)
            out[std::size_t(v)] += (kSmoothBins + 1 - std::abs(near - v)) * sharp[std::size_t(near)];
    return out;
}

} // namespace

std::optional<RegionGuess> guessRegion(const volume::DerivativeHistogram& histogram) {
    const std::vector<double> sums = strengths(histogram);
    const auto peak = std::max_element(sums.begin(), sums.end());
    const double width = histogram.range.hi - histogram.range.lo;
    if (peak == sums.end() || !(*peak > 0) || !(width > 0)) return std::nullopt;
    const double unit = histogram.gradientTop / width; // ranges per cell at the histogram's top
    RegionGuess out;
    const double top = gradientBelow(histogram, 0, histogram.valueBins, kBelowTop) * kTopRoom;
    out.gradientTop = float(std::clamp(top * unit, 1e-3, 2.0));
    auto from = peak, to = peak;
    while (from != sums.begin() && *(from - 1) > *peak / 2) --from;
    while (to != sums.end() && *to > *peak / 2) ++to;
    const int first = int(from - sums.begin()), last = int(to - sums.begin());
    const double bins = histogram.valueBins, high = double(out.gradientTop) / unit;
    const double lo = gradientBelow(histogram, first, last, kLowest) / high,
                 hi = std::min(1.0, gradientBelow(histogram, first, last, kMost) / high);
    out.region.centre = {float((first + last) / (2 * bins)), float((lo + hi) / 2)};
    out.region.size = {float(std::max((last - first) / bins, 0.02)), float(std::max(hi - lo, 0.05))};
    return out;
}

void setGradientTop(TransferFunction& function, float top) {
    if (!(top > 0) || !(function.gradientTop > 0)) return;
    const float factor = function.gradientTop / top;
    for (TransferRegion& region : function.regions) {
        region.centre.y *= factor;
        region.size.y *= factor;
    }
    function.gradientTop = top;
}

glm::dvec4 shownAs(const TransferFunction& function, Range range, double value) {
    const glm::dvec4 curve = evaluate(function, range, value);
    if (function.kind == TransferKind::Curve) return curve;
    glm::dvec3 colors(0);
    double weights = 0, most = 0;
    for (int i = 0; i <= kShownGradients; ++i) {
        const double gradient = double(function.gradientTop) * i / kShownGradients;
        const glm::dvec4 here = evaluate(function, range, value, gradient);
        colors += here.a * glm::dvec3(here);
        weights += here.a;
        most = std::max(most, here.a);
    }
    return weights > 0 ? glm::dvec4(colors / weights, most) : glm::dvec4(glm::dvec3(curve), 0);
}

} // namespace tessera::vis
