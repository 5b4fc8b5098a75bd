#include "volume/worth/odd_places.h"

#include "volume/base/parallel.h"
#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace tessera::volume {

namespace {

constexpr double kOddChance = 0.01;    ///< chances below which samples belong to a place
constexpr double kLeastJump = 0.05;    ///< of a parameter's spread: smaller ones are not worth a look
constexpr std::size_t kMostPlaces = 3; ///< of a parameter and kind
constexpr std::size_t kFewestSamples = 40;

/// A sample that stands out: how far, and its chance.
struct OddSample {
    std::size_t sample = 0;
    double size = 0;  ///< its distance or jump, in the parameter's unit
    double other = 0; ///< the value that it is compared with
    double p = 1;
};

struct OddPart {
    std::vector<std::size_t> samples;
    std::vector<float> sorted; ///< their values
    double spread = 0;         ///< twice that between the quartiles; more where most are alike
    double least = 0;          ///< differences below are rounding
};

OddPart oddPartOf(const WorthSamples& samples, const std::vector<float>& values, std::size_t group) {
    OddPart part;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isnan(values[i]) && samples.isIn(i, group)) {
            part.samples.push_back(i);
            part.sorted.push_back(values[i]);
        }
    if (part.sorted.empty()) return part;
    std::ranges::sort(part.sorted);
    const double most = std::max(std::abs(double(part.sorted.front())), std::abs(double(part.sorted.back())));
    part.least = 1e-6 * most;
    part.spread = std::max({2 * (rankedQuantile(part.sorted, 0.75) - rankedQuantile(part.sorted, 0.25)),
                            0.01 * double(part.sorted.back() - part.sorted.front()), part.least});
    return part;
}

std::vector<OddSample> oddValues(const std::vector<float>& values, const OddPart& part) {
    std::vector<OddSample> odd;
    const double median = rankedQuantile(part.sorted, 0.5);
    for (const double side : {-1.0, 1.0}) {
        std::vector<float> away;
        for (const float value : part.sorted)
            if (side * (double(value) - median) >= 0) away.push_back(float(side * (double(value) - median)));
        std::ranges::sort(away);
        for (const std::size_t i : part.samples) {
            const double distance = side * (double(values[i]) - median);
            if (distance < part.least || distance < 0.25 * part.spread) continue;
            const double p = expectedBeyond(away, distance, double(away.size()), 0.02 * part.spread);
            if (p < kOddChance) odd.push_back({i, distance, median, p});
        }
    }
    return odd;
}

/// The difference of a sample to the next along an axis, less the median of those between the same planes.
struct PlaneStep {
    std::size_t sample = 0;
    float residual = 0; ///< |difference - median|
    float relative = 0; ///< by the median residual of its planes
};

std::vector<PlaneStep> stepsAlong(const WorthSamples& samples, const std::vector<float>& values, const OddPart& part,
                                  std::size_t group, int axis) {
    const std::size_t step = samples.step(axis);
    std::vector<std::vector<PlaneStep>> planes(std::size_t(samples.size[axis]));
    for (const std::size_t i : part.samples) {
        const int at = samples.indexOf(i)[axis];
        if (at + 1 >= samples.size[axis] || std::isnan(values[i + step]) || !samples.isIn(i + step, group)) continue;
        planes[std::size_t(at)].push_back({i, values[i + step] - values[i], 0});
    }
    std::vector<float> middles;
    std::erase_if(planes, [](const auto& plane) { return plane.size() < 12; });
    for (std::vector<PlaneStep>& plane : planes) {
        const auto half = plane.begin() + std::ptrdiff_t(plane.size() / 2);
        std::nth_element(plane.begin(), half, plane.end(),
                         [](const PlaneStep& a, const PlaneStep& b) { return a.residual < b.residual; });
        const float median = half->residual;
        for (PlaneStep& each : plane) each.residual = std::abs(each.residual - median);
        std::nth_element(plane.begin(), half, plane.end(),
                         [](const PlaneStep& a, const PlaneStep& b) { return a.residual < b.residual; });
        middles.push_back(half->residual);
    }
    if (middles.empty()) return {};
    std::vector<float> ranked = middles;
    std::nth_element(ranked.begin(), ranked.begin() + std::ptrdiff_t(ranked.size() / 2), ranked.end());
    const float floor = std::max(ranked[ranked.size() / 2], float(part.least));
    std::vector<PlaneStep> all;
    for (std::size_t p = 0; p < planes.size(); ++p)
        for (PlaneStep each : planes[p]) {
            each.relative = each.residual / std::max(middles[p], floor);
            all.push_back(each);
        }
    return all;
}

std::vector<OddSample> oddJumps(const WorthSamples& samples, const std::vector<float>& values, const OddPart& part,
                                std::size_t group) {
    std::vector<OddSample> odd;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<PlaneStep> steps = stepsAlong(samples, values, part, group, axis);
        std::vector<float> sorted;
        for (const PlaneStep& each : steps) sorted.push_back(each.relative);
        std::ranges::sort(sorted);
        for (const PlaneStep& each : steps) {
            if (double(each.residual) < kLeastJump * part.spread || double(each.residual) < 10 * part.least) continue;
            const double p = 3 * expectedBeyond(sorted, double(each.relative), double(sorted.size()), 0.1);
            if (p >= kOddChance) continue;
            const std::size_t next = each.sample + samples.step(axis);
            odd.push_back({each.sample, double(each.residual), double(values[next]), p});
            odd.push_back({next, double(each.residual), double(values[each.sample]), p});
        }
    }
    return odd;
}

/// Sets of neighbours, also across edges and corners.
std::vector<std::vector<OddSample>> connectedSets(const WorthSamples& samples, const std::vector<OddSample>& odd) {
    std::vector<int> of(samples.count(), -1); // position in `best`
    std::vector<OddSample> best;
    for (const OddSample& each : odd) {
        int& at = of[each.sample];
        if (at < 0) {
            at = int(best.size());
            best.push_back(each);
        } else if (each.size > best[std::size_t(at)].size)
            best[std::size_t(at)] = each;
    }
    std::vector<std::vector<OddSample>> sets;
    std::vector<bool> seen(best.size());
    for (std::size_t first = 0; first < best.size(); ++first) {
        if (seen[first]) continue;
        seen[first] = true;
        std::deque<std::size_t> front{first};
        std::vector<OddSample>& set = sets.emplace_back();
        while (!front.empty()) {
            const OddSample now = best[front.front()];
            front.pop_front();
            set.push_back(now);
            const glm::ivec3 at = samples.indexOf(now.sample);
            for (int d = 0; d < 27; ++d) {
                const glm::ivec3 beside = at + glm::ivec3(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
                bool within = true;
                for (int axis = 0; axis < 3; ++axis)
                    within = within && beside[axis] >= 0 && beside[axis] < samples.size[axis];
                if (!within) continue;
                const int found = of[std::size_t(beside.x) + std::size_t(beside.y) * samples.step(1) +
                                     std::size_t(beside.z) * samples.step(2)];
                if (found < 0 || seen[std::size_t(found)]) continue;
                seen[std::size_t(found)] = true;
                front.push_back(std::size_t(found));
            }
        }
    }
    return sets;
}

/// A set as a finding: its strongest sample, and the box around it.
Finding oddPlaceOf(const WorthSamples& samples, const std::vector<float>& values, const OddPart& part,
                   std::size_t channel, std::size_t group, FindingKind kind, const std::vector<OddSample>& set) {
    Finding out{.kind = kind, .x = samples.channels[channel]};
    if (group > 0) out.region = samples.regions[group - 1];
    const OddSample* most = &set.front();
    out.p = 1;
    out.box = {samples.placeOf(most->sample), samples.placeOf(most->sample)};
    out.values = {double(values[most->sample]), double(values[most->sample])};
    for (const OddSample& each : set) {
        if (each.size > most->size) most = &each;
        out.p = std::min(out.p, each.p);
        const glm::dvec3 at = samples.placeOf(each.sample);
        for (int axis = 0; axis < 3; ++axis) {
            out.box.lo[axis] = std::min(out.box.lo[axis], at[axis]);
            out.box.hi[axis] = std::max(out.box.hi[axis], at[axis]);
        }
        const double value = double(values[each.sample]);
        out.values = {std::min(out.values.lo, value), std::max(out.values.hi, value)};
    }
    out.number = double(values[most->sample]);
    out.other = most->other;
    // Of both ends of a jump the one farther from what is usual is the odd one.
    if (const double usual = rankedQuantile(part.sorted, 0.5);
        kind == FindingKind::Jump && std::abs(out.other - usual) > std::abs(out.number - usual))
        std::swap(out.number, out.other);
    out.place = samples.placeOf(most->sample);
    const double times = most->size / part.spread;
    out.strength = times / (1 + times);
    out.samples = double(set.size());
    out.effective = 1; // one place
    return out;
}

/// The places of a parameter in a group; the same place as a jump and as oddValues is there once. `leastSpread`: what
/// is small beside it is not worth a look.
Findings placesOf(const WorthSamples& samples, std::size_t channel, std::size_t group, double leastSpread) {
    const std::vector<float>& values = samples.values[channel];
    OddPart part = oddPartOf(samples, values, group);
    part.spread = std::max(part.spread, leastSpread);
    Findings out;
    if (part.sorted.size() < kFewestSamples || double(part.sorted.back() - part.sorted.front()) <= 10 * part.least)
        return out;
    std::vector<Finding> all;
    for (const FindingKind kind : {FindingKind::Outliers, FindingKind::Jump}) {
        ++out.tests;
        const std::vector<OddSample> odd =
            kind == FindingKind::Outliers ? oddValues(values, part) : oddJumps(samples, values, part, group);
        std::vector<Finding> found;
        for (const std::vector<OddSample>& set : connectedSets(samples, odd))
            found.push_back(oddPlaceOf(samples, values, part, channel, group, kind, set));
        std::ranges::stable_sort(found, [](const Finding& a, const Finding& b) { return a.strength > b.strength; });
        if (found.size() > kMostPlaces) found.resize(kMostPlaces);
        all.insert(all.end(), found.begin(), found.end());
    }
    // Outliers are first: their borders jump, too.
    for (const Finding& each : all) {
        const bool known = std::ranges::any_of(out.found, [&](const Finding& other) {
            for (int axis = 0; axis < 3; ++axis)
                if (each.box.lo[axis] > other.box.hi[axis] || each.box.hi[axis] < other.box.lo[axis]) return false;
            return true;
        });
        if (!known) out.found.push_back(each);
    }
    out.tests += out.found.empty() ? 0 : out.found.size() - 1;
    return out;
}

} // namespace

Findings findOddPlaces(const WorthSamples& samples, const Progress& progress) {
    const std::size_t groups = samples.regions.empty() ? 1 : samples.regions.size();
    std::vector<Findings> found(samples.values.size() * groups);
    progress.advance(0, "odd places");
    std::vector<double> leastSpreads(samples.values.size()); // of parts beside the whole parameter
    if (!samples.regions.empty())
        parallelFor(leastSpreads.size(), [&](std::size_t c) {
            if (progress.stop.stop_requested()) throw Cancelled();
            leastSpreads[c] = 0.2 * oddPartOf(samples, samples.values[c], 0).spread;
        });
    parallelFor(found.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        found[i] =
            placesOf(samples, i / groups, samples.regions.empty() ? 0 : 1 + i % groups, leastSpreads[i / groups]);
    });
    progress.advance(1, "odd places");
    Findings all;
    for (const Findings& each : found) {
        all.tests += each.tests;
        all.found.insert(all.found.end(), each.found.begin(), each.found.end());
    }
    return all;
}

} // namespace tessera::volume
