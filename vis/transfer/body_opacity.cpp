#include "vis/transfer/body_opacity.h"

#include "vis/transfer/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::vis {

namespace {

/// Optical depth along a ray of mean length: of all volume alike, and of all values together.
constexpr double kOfVolume = 0.3, kOfValues = 0.8;
constexpr double kMostOpacity = 0.8;
/// Of the emphasis 1: what the lowest value gets, and the least magnitude, which is next to nothing.
constexpr double kOfLowest = 0.3, kOfLeast = 0.1;
constexpr double kOccurs = 2e-5; ///< share of the volume from which on a bin counts as occupied
constexpr double kExact = 0.2;   ///< of an opacity: the error of a point that is left out

/// Shares of the volume, smoothed by a triangle over a 40th of the range to either side, among the bins that are not
/// empty: the ends of what occurs are no rarer for that.
std::vector<double> sharesOf(std::span<const double> count, double all) {
    const int bins = int(count.size()), reach = std::max(1, bins / 40);
    std::vector<double> out(count.size(), 0);
    for (int bin = 0; bin < bins; ++bin) {
        if (!(count[std::size_t(bin)] > kOccurs * all)) continue;
        double sum = 0, weights = 0;
        for (int near = std::max(bin - reach, 0); near <= std::min(bin + reach, bins - 1); ++near) {
            if (!(count[std::size_t(near)] > 0)) continue;
            const double weight = reach + 1 - std::abs(near - bin);
            sum += weight * count[std::size_t(near)];
            weights += weight;
        }
        out[std::size_t(bin)] = sum / (weights * all);
    }
    return out;
}

double weightOf(double x, Emphasis emphasis) {
    return emphasis == Emphasis::High ? std::lerp(kOfLowest, 1.0, x) : std::lerp(kOfLeast, 1.0, std::abs(2 * x - 1));
}

/// Fills gaps between positive numbers by their neighbours: evenly in the logarithm, beyond the ends as they are.
void fillGaps(std::vector<double>& numbers) {
    std::size_t last = numbers.size();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!(numbers[i] > 0)) continue;
        if (last == numbers.size()) std::fill(numbers.begin(), numbers.begin() + long(i), numbers[i]);
        for (std::size_t gap = last + 1; last < numbers.size() && gap < i; ++gap)
            numbers[gap] = std::exp(
                std::lerp(std::log(numbers[last]), std::log(numbers[i]), double(gap - last) / double(i - last)));
        last = i;
    }
    if (last < numbers.size()) std::fill(numbers.begin() + long(last), numbers.end(), numbers[last]);
}

/// Adds the points between two that a line does not meet (D. H. Douglas, T. K. Peucker, 1973).
void addPoints(std::span<const glm::vec2> all, std::size_t from, std::size_t to, std::vector<glm::vec2>& out) {
    double worst = 1;
    std::size_t at = 0;
    for (std::size_t i = from + 1; i < to; ++i) {
        const double share = double(all[i].x - all[from].x) / double(all[to].x - all[from].x);
        const double line = std::lerp(double(all[from].y), double(all[to].y), share);
        const double error = std::abs(line - double(all[i].y)) / (kExact * double(all[i].y) + 0.008);
        if (error > worst) worst = error, at = i;
    }
    if (at == 0) return;
    addPoints(all, from, at, out);
    out.push_back(all[at]);
    addPoints(all, at, to, out);
}

} // namespace

std::vector<glm::vec2> bodyOpacity(std::span<const double> count, double length, Emphasis emphasis) {
    const double all = std::accumulate(count.begin(), count.end(), 0.0), bins = double(count.size());
    if (!(all > 0) || !(length > 0) || count.size() < 2) return {{0.0f, 0.0f}, {1.0f, float(kMostOpacity)}};
    const std::vector<double> shares = sharesOf(count, all);
    const auto place = [&](std::size_t bin) { return (double(bin) + 0.5) / bins; };
    double weights = 0;
    for (std::size_t bin = 0; bin < shares.size(); ++bin)
        if (shares[bin] > 0) weights += weightOf(place(bin), emphasis);
    std::vector<double> opacity(shares.size(), 0);
    for (std::size_t bin = 0; bin < shares.size(); ++bin) {
        if (!(shares[bin] > 0)) continue;
        const double weight = weightOf(place(bin), emphasis);
        const double volume = emphasis == Emphasis::High ? 1 : weight;
        const double depth = (kOfVolume * volume + kOfValues * weight / (weights * shares[bin])) / length;
        opacity[bin] = std::min(1 - std::exp(-depth * kReferenceLength), kMostOpacity);
    }
    fillGaps(opacity);
    std::vector<glm::vec2> points{{0.0f, float(opacity.front())}};
    for (std::size_t bin = 0; bin < opacity.size(); ++bin) points.emplace_back(float(place(bin)), float(opacity[bin]));
    points.emplace_back(1.0f, float(opacity.back()));
    std::vector<glm::vec2> curve{points.front()};
    addPoints(points, 0, points.size() - 1, curve);
    curve.push_back(points.back());
    return curve;
}

} // namespace tessera::vis
