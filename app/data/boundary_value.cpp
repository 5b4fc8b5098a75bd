#include "app/data/boundary_value.h"

#include "app/data/coarse_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tessera::app {

namespace {

constexpr int kValueBins = 256;
constexpr auto kEveryBrick = [](glm::ivec3, glm::ivec3) { return true; };

std::size_t binOf(double value, Range range) {
    const double share = (value - range.lo) / (range.hi - range.lo);
    return static_cast<std::size_t>(std::clamp(share * kValueBins, 0.0, kValueBins - 1.0));
}

double middleOfBin(std::size_t bin, Range range) {
    return range.lo + (static_cast<double>(bin) + 0.5) / kValueBins * (range.hi - range.lo);
}

/// Calls use(value, |grad f|) for the samples of a brick, but for those on its faces. `step`: distance of the
/// neighbours in the array; `cell`: half their distance in space, in any unit.
template <class Use> void forGradients(const volume::BrickSamples& samples, glm::ivec3 step, glm::dvec3 cell, Use use) {
    const glm::ivec3 size = samples.size;
    const std::array<std::size_t, 3> stride{1, std::size_t(size.x), std::size_t(size.x) * std::size_t(size.y)};
    for (int k = step.z; k < size.z - step.z; ++k)
        for (int j = step.y; j < size.y - step.y; ++j)
            for (int i = step.x; i < size.x - step.x; ++i) {
                const std::size_t at = std::size_t(i) + std::size_t(j) * stride[1] + std::size_t(k) * stride[2];
                if (!samples.isPresent(at)) continue;
                glm::dvec3 gradient(0);
                bool whole = true;
                for (int axis = 0; axis < 3; ++axis) {
                    const std::size_t away = std::size_t(step[axis]) * stride[std::size_t(axis)];
                    whole = whole && samples.isPresent(at - away) && samples.isPresent(at + away);
                    gradient[axis] =
                        (double(samples.values[at + away]) - double(samples.values[at - away])) / (2 * cell[axis]);
                }
                if (whole) use(double(samples.values[at]), glm::length(gradient));
            }
}

/// The same for a coarse level of a whole time; lengths in the shortest edge of a cell.
template <class Use> void forGradients(const volume::BrickSource& source, int channel, int time, Use use) {
    const volume::BrickGrid& grid = source.grid();
    // Storage of BCC holds the two sublattices in alternating planes.
    const glm::ivec3 step(1, 1, grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1);
    const glm::dvec3 spacing = grid.lattice.spacing;
    const glm::dvec3 cell = spacing / std::max(std::min({spacing.x, spacing.y, spacing.z}), 1e-300);
    forBricks(source, channel, time, grid.levelWithin(kQuickSamples), kEveryBrick,
              [&](glm::ivec3, const volume::BrickSamples& samples) { forGradients(samples, step, cell, use); });
}

/// The bin in [first, end) with the greatest sum, smoothed since scans do not have every value; nullopt: all are 0.
std::optional<std::size_t> peakOf(const std::array<double, kValueBins>& sums, int first, int end = kValueBins) {
    constexpr int kSmooth = 4; // bins on either side
    std::optional<std::size_t> best;
    double most = 0;
    for (int bin = first; bin < end; ++bin) {
        double sum = 0;
        for (int near = std::max(bin - kSmooth, 0); near <= std::min(bin + kSmooth, kValueBins - 1); ++near)
            sum += (kSmooth + 1 - std::abs(near - bin)) * sums[std::size_t(near)];
        if (sum > most) most = sum, best = std::size_t(bin);
    }
    return best;
}

constexpr int kClusterBins = kValueBins / 10;

/// Neighbouring bins that hold most of what is counted, outside of `taken`.
struct Cluster {
    int begin = 0, end = 0;
    double count = 0;
};
Cluster largestCluster(const std::array<double, kValueBins>& count, const Cluster& taken = {}) {
    Cluster best;
    for (int begin = 0; begin + kClusterBins <= kValueBins; ++begin) {
        const int end = begin + kClusterBins;
        if (begin < taken.end && end > taken.begin) continue;
        const double sum = std::accumulate(count.begin() + begin, count.begin() + end, 0.0);
        if (sum > best.count) best = {begin, end, sum};
    }
    return best;
}

/// Calls use(value) for the samples of a coarse level on the outer faces of the box.
template <class Use> void forFaces(const volume::BrickSource& source, int channel, int time, Use use) {
    const int level = source.grid().levelWithin(kQuickSamples);
    const glm::ivec3 last = source.grid().levelSamples(level) - 1;
    const auto isOuter = [](glm::ivec3 at, glm::ivec3 end) {
        return glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, end));
    };
    forSamples(
        source, channel, time, level, [&](glm::ivec3 index, glm::ivec3 count) { return isOuter(index, count - 1); },
        [&](glm::ivec3 at, float value) {
            if (isOuter(at, last)) use(value);
        });
}

/// Share of the samples on the outer faces of the box that are below a value.
double shareOfFacesBelow(const volume::BrickSource& source, int channel, int time, double value) {
    double below = 0, all = 0;
    forFaces(source, channel, time, [&](float sample) {
        below += double(sample) < value ? 1 : 0;
        all += 1;
    });
    return all > 0 ? below / all : 0;
}

} // namespace

std::optional<double> backgroundShare(const volume::BrickSource& source, int channel, int time) {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel what = info.channel(channel);
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(what.parameter)];
    const Range range = info.channelRange(what);
    const bool integer = parameter.type != volume::ScalarType::F32 && !parameter.categorical;
    if (!integer || !(range.hi > range.lo)) return std::nullopt;
    std::vector<std::uint64_t> histogram(256, 0);
    std::uint64_t total = 0;
    forFaces(source, channel, time, [&](float value) {
        const double share = (value - range.lo) / (range.hi - range.lo);
        ++histogram[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * 255)];
        ++total;
    });
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
        below += histogram[bin];
        if (static_cast<double>(below) < 0.99 * static_cast<double>(total)) continue;
        // Noise is weaker at this coarse level than at full resolution.
        const double edge = static_cast<double>(bin + 1) / 255, share = edge < 0.01 ? edge : 1.3 * edge + 0.02;
        return total > 0 && share < 0.5 ? std::optional(share) : std::nullopt;
    }
    return std::nullopt;
}

std::optional<double> boundaryValue(const volume::BrickSource& source, int channel, int time) {
    const Range range = source.info().channelRange(source.info().channel(channel));
    if (!(range.hi > range.lo)) return std::nullopt;
    std::array<double, kValueBins> sums{};
    forGradients(source, channel, time,
                 [&](double value, double gradient) { sums[binOf(value, range)] += std::pow(gradient, 3); });
    const double background = backgroundShare(source, channel, time).value_or(0);
    const auto best = peakOf(sums, static_cast<int>(std::ceil(background * kValueBins)));
    return best ? std::optional(middleOfBin(*best, range)) : std::nullopt;
}

std::optional<Materials> materialsOf(const volume::BrickSource& source, int channel, int time) {
    // Of the range: change per cell up to which nothing changes, and from which a boundary is steep.
    constexpr double kFlat = 0.04, kSteep = 0.08;
    constexpr double kFlatShare = 0.5, kClustered = 0.8, kLeastCluster = 0.005, kLeastFaces = 0.3; // of the samples
    const volume::DatasetInfo& info = source.info();
    const volume::Channel what = info.channel(channel);
    const Range range = info.channelRange(what);
    if (info.parameters[static_cast<std::size_t>(what.parameter)].categorical || !(range.hi > range.lo))
        return std::nullopt;
    std::array<double, kValueBins> flat{}, sums{}, steepness{}, count{};
    double all = 0, flats = 0;
    forGradients(source, channel, time, [&](double value, double gradient) {
        const double change = gradient / (range.hi - range.lo);
        const std::size_t bin = binOf(value, range);
        all += 1;
        count[bin] += 1;
        steepness[bin] += change;
        sums[bin] += std::pow(change, 3);
        if (change < kFlat) flat[bin] += 1, flats += 1;
    });
    if (!(flats > kFlatShare * all)) return std::nullopt;
    const Cluster one = largestCluster(flat), two = largestCluster(flat, one);
    const Cluster &lower = one.begin < two.begin ? one : two, &upper = one.begin < two.begin ? two : one;
    if (one.count + two.count < kClustered * flats || two.count < kLeastCluster * all) return std::nullopt;
    if (upper.begin - lower.end < kClusterBins / 2) return std::nullopt; // one that is wide
    const auto peak = peakOf(sums, lower.end, upper.end);
    if (!peak) return std::nullopt;
    const double steep = steepness[*peak] / std::max(count[*peak], 1.0);
    if (steep < kSteep) return std::nullopt;
    const double boundary = middleOfBin(*peak, range);
    if (shareOfFacesBelow(source, channel, time, boundary) < kLeastFaces) return std::nullopt;
    double passed = 0;
    int top = lower.begin;
    while (top + 1 < lower.end && (passed += flat[std::size_t(top)]) < 0.99 * lower.count) ++top;
    return Materials{(top + 1.0) / kValueBins, (boundary - range.lo) / (range.hi - range.lo)};
}

namespace {

/// Moments of a part of a histogram.
struct Moments {
    double count = 0, mean = 0, deviation = 0;
};
Moments momentsOf(const std::array<double, kValueBins>& count, int begin, int end) {
    Moments out;
    double squares = 0;
    for (int bin = begin; bin < end; ++bin) {
        out.count += count[std::size_t(bin)];
        out.mean += bin * count[std::size_t(bin)];
        squares += double(bin) * bin * count[std::size_t(bin)];
    }
    if (!(out.count > 0)) return out;
    out.mean /= out.count;
    out.deviation = std::sqrt(std::max(squares / out.count - out.mean * out.mean, 0.0));
    return out;
}

/// Samples in the bins around one.
double samplesAround(const std::array<double, kValueBins>& count, int bin) {
    double sum = 0;
    for (int near = std::max(bin - 4, 0); near <= std::min(bin + 4, kValueBins - 1); ++near)
        sum += count[std::size_t(near)];
    return sum;
}

} // namespace

bool hasMaterials(const volume::BrickSource& source, int channel, int time, double background) {
    constexpr double kFlat = 0.04;                               // of the range, from cell to cell
    constexpr double kMost = 0.5, kLeastPeak = 0.005, kRise = 3; // of the samples; of what is least before
    const Range range = source.info().channelRange(source.info().channel(channel));
    if (!(range.hi > range.lo)) return false;
    const int first = int(std::ceil(background * kValueBins));
    std::array<double, kValueBins> count{};
    double all = 0, flat = 0;
    forGradients(source, channel, time, [&](double value, double gradient) {
        const std::size_t bin = binOf(value, range);
        if (int(bin) < first) return;
        all += 1;
        count[bin] += 1;
        flat += gradient < kFlat * (range.hi - range.lo) ? 1 : 0;
    });
    if (flat > kMost * all) return true;
    double least = std::numeric_limits<double>::infinity(), above = all;
    for (int bin = first; bin < kValueBins; above -= count[std::size_t(bin++)]) {
        if (above < kMost * all) return false;
        const double here = samplesAround(count, bin);
        if (here > kLeastPeak * all && here > kRise * least) return true;
        least = std::min(least, here);
    }
    return false;
}

std::optional<Materials> classesOf(const volume::BrickSource& source, int channel, int time) {
    constexpr double kLeastClass = 0.02, kValley = 0.4; // of the samples; of the lower peak
    const Range range = source.info().channelRange(source.info().channel(channel));
    if (!(range.hi > range.lo)) return std::nullopt;
    std::array<double, kValueBins> count{};
    forSamples(source, channel, time, source.grid().levelWithin(kQuickSamples), kEveryBrick,
               [&](glm::ivec3, float value) { ++count[binOf(double(value), range)]; });
    int edge = 0;
    double most = 0;
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    for (int bin = 1; bin < kValueBins; ++bin) {
        const Moments lower = momentsOf(count, 0, bin), upper = momentsOf(count, bin, kValueBins);
        const double between = lower.count * upper.count * std::pow(upper.mean - lower.mean, 2);
        if (between > most) most = between, edge = bin;
    }
    const Moments lower = momentsOf(count, 0, edge), upper = momentsOf(count, edge, kValueBins);
    if (std::min(lower.count, upper.count) < kLeastClass * all) return std::nullopt;
    double below = 0, above = 0, valley = std::numeric_limits<double>::infinity();
    for (int bin = 0; bin < kValueBins; ++bin) {
        double& peak = bin < edge ? below : above;
        peak = std::max(peak, samplesAround(count, bin));
    }
    for (int bin = int(lower.mean); bin <= int(upper.mean); ++bin) valley = std::min(valley, samplesAround(count, bin));
    if (valley > kValley * std::min(below, above)) return std::nullopt;
    const double start = std::min(lower.mean + 2 * lower.deviation, double(edge));
    return Materials{start / kValueBins, double(edge) / kValueBins};
}

std::optional<double> middleValue(const volume::BrickSource& source, int channel, int time) {
    const Range range = source.info().channelRange(source.info().channel(channel));
    if (!(range.hi > range.lo)) return std::nullopt;
    std::array<double, kValueBins> count{};
    forSamples(source, channel, time, source.grid().levelWithin(kQuickSamples), kEveryBrick,
               [&](glm::ivec3, float value) { ++count[binOf(value, range)]; });
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    const auto quantile = [&](double share) {
        double below = 0;
        std::size_t bin = 0;
        while (bin + 1 < count.size() && (below += count[bin]) < share * all) ++bin;
        return bin;
    };
    const std::size_t lo = quantile(0.02), hi = quantile(0.98);
    if (all == 0 || lo == hi) return std::nullopt;
    return 0.5 * (middleOfBin(lo, range) + middleOfBin(hi, range));
}

std::optional<double> surfaceValue(const volume::BrickSource& source, int channel, int time) {
    const volume::Channel what = source.info().channel(channel);
    const volume::Parameter& parameter = source.info().parameters[static_cast<std::size_t>(what.parameter)];
    const bool scan = parameter.type != volume::ScalarType::F32 && !parameter.categorical;
    return scan ? boundaryValue(source, channel, time) : middleValue(source, channel, time);
}

} // namespace tessera::app
