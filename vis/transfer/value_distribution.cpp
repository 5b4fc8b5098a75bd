#include "vis/transfer/value_distribution.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

constexpr double kSpikeShare = 0.3, kSpikeStep = 1.0 / 3;

/// Number of samples of values between two shares of the range, in bins that are even inside.
double samplesBetween(const std::vector<std::uint64_t>& count, double from, double to) {
    double sum = 0;
    for (std::size_t bin = 0; bin < count.size(); ++bin) {
        const double lo = double(bin) / double(count.size()), hi = double(bin + 1) / double(count.size());
        const double covered = std::min(hi, to) - std::max(lo, from);
        if (covered > 0) sum += double(count[bin]) * std::min(1.0, covered * double(count.size()));
    }
    return sum;
}

double shareOf(const ValueDistribution& values, double value) {
    const double width = values.range.hi - values.range.lo;
    return width > 0 ? std::clamp((value - values.range.lo) / width, 0.0, 1.0) : 0.0;
}

} // namespace

double spikeBackground(const std::vector<std::uint64_t>& count) {
    double all = 0;
    for (const std::uint64_t each : count) all += double(each);
    const auto first = std::ranges::find_if(count, [](std::uint64_t each) { return each > 0; });
    if (first == count.end() || first + 1 == count.end()) return 0;
    const bool spike = double(*first) >= kSpikeShare * all && double(*(first + 1)) <= kSpikeStep * double(*first);
    return spike ? double(first + 1 - count.begin()) / double(count.size()) : 0;
}

ValueDistribution magnitudesOf(const ValueDistribution& values) {
    ValueDistribution out;
    const double most = std::max(std::abs(values.range.lo), std::abs(values.range.hi));
    out.range = {0, most > 0 ? most : 1};
    out.count.assign(values.count.size(), 0);
    const double bins = double(values.count.size());
    for (std::size_t bin = 0; bin < values.count.size(); ++bin) {
        const double middle = glm::mix(values.range.lo, values.range.hi, (double(bin) + 0.5) / bins);
        const double at = std::min(std::abs(middle) / out.range.hi * bins, bins - 1);
        out.count[std::size_t(at)] += values.count[bin];
    }
    return out;
}

double valueAtPlace(const ValueDistribution& values, double place) {
    const double edge = std::clamp(values.background, 0.0, 1.0);
    const auto value = [&](double share) { return glm::mix(values.range.lo, values.range.hi, share); };
    place = std::clamp(place, -1.0, 1.0);
    if (place < 0) return value(edge * (place + 1));
    const double all = samplesBetween(values.count, edge, 1);
    if (all <= 0) return value(glm::mix(edge, 1.0, place));
    if (place == 0) return value(edge);
    const double wanted = place * all, bins = double(values.count.size());
    double below = 0;
    for (std::size_t bin = 0; bin < values.count.size(); ++bin) {
        const double lo = std::max(double(bin) / bins, edge), hi = double(bin + 1) / bins;
        const double here = hi > lo ? double(values.count[bin]) * (hi - lo) * bins : 0;
        // The tolerance is for the sum at place 1, which is rounded.
        if (here > 0 && below + here >= wanted * (1 - 1e-12))
            return value(glm::mix(lo, hi, std::clamp((wanted - below) / here, 0.0, 1.0)));
        below += here;
    }
    return values.range.hi;
}

double placeOfValue(const ValueDistribution& values, double value) {
    const double edge = std::clamp(values.background, 0.0, 1.0), share = shareOf(values, value);
    if (share < edge) return share / edge - 1;
    const double all = samplesBetween(values.count, edge, 1);
    if (all <= 0) return edge < 1 ? (share - edge) / (1 - edge) : 0;
    return std::min(1.0, samplesBetween(values.count, edge, share) / all);
}

} // namespace tessera::vis
