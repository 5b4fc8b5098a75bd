#include "volume/worth/changes.h"

#include "volume/base/parallel.h"
#include "volume/worth/effective_samples.h"
#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

/// One step of one channel.
struct StepChange {
    double square = 0; ///< mean
    double samples = 0, effective = 1;
    double block = 0;      ///< greatest RMS of a block
    double signedMean = 0; ///< of that block
    glm::dvec3 place{0};   ///< of its greatest change
    std::optional<int> region = {};
    double sum = 0, sumSquares = 0, values = 0; ///< of the later values
    double largest = 0;
};

/// Mean square changes of blocks of the grid, at most 12 along an axis.
struct ChangeBlocks {
    glm::ivec3 size, count;
    explicit ChangeBlocks(glm::ivec3 samples) {
        for (int axis = 0; axis < 3; ++axis) {
            size[axis] = (samples[axis] + 11) / 12;
            count[axis] = (samples[axis] + size[axis] - 1) / size[axis];
        }
    }
    std::size_t of(glm::ivec3 at) const {
        const glm::ivec3 b = at / size;
        return (std::size_t(b.z) * std::size_t(count.y) + std::size_t(b.y)) * std::size_t(count.x) + std::size_t(b.x);
    }
    std::size_t all() const { return std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z); }
};

StepChange stepChangeOf(const WorthSamples& before, const WorthSamples& now, std::size_t channel) {
    StepChange out;
    const std::vector<float>&a = before.values[channel], &b = now.values[channel];
    std::vector<float> change(a.size());
    const ChangeBlocks blocks(now.size);
    std::vector<double> squares(blocks.all()), sums(blocks.all()), counts(blocks.all());
    std::vector<std::size_t> most(blocks.all(), a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        change[i] = b[i] - a[i]; // NaN where one is absent
        if (!std::isnan(b[i])) {
            out.sum += double(b[i]), out.sumSquares += double(b[i]) * double(b[i]), out.values += 1;
            out.largest = std::max(out.largest, std::abs(double(b[i])));
        }
        if (std::isnan(change[i])) continue;
        const double by = double(change[i]);
        out.square += by * by, out.samples += 1;
        const std::size_t block = blocks.of(now.indexOf(i));
        squares[block] += by * by, sums[block] += by, counts[block] += 1;
        if (most[block] == a.size() || std::abs(by) > std::abs(double(change[most[block]]))) most[block] = i;
    }
    if (out.samples == 0) return out;
    out.square /= out.samples;
    double best = -1;
    const double fewest = 0.25 * double(blocks.size.x) * double(blocks.size.y) * double(blocks.size.z);
    for (std::size_t k = 0; k < squares.size(); ++k)
        if (counts[k] > 0 && counts[k] >= fewest && squares[k] / counts[k] > best) {
            best = squares[k] / counts[k];
            out.block = std::sqrt(best);
            out.signedMean = sums[k] / counts[k];
            out.place = now.placeOf(most[k]);
            if (!now.group.empty() && now.group[most[k]] > 0) out.region = now.regions[now.group[most[k]] - 1u];
        }
    WorthSamples plain; // of all samples, whatever their region
    plain.size = now.size;
    const std::vector<Correlogram> lags = correlograms(plain, change);
    out.effective = effectiveSamples(out.samples, correlationLengths(lags[0], lags[0]));
    return out;
}

/// The lower quartile of some numbers, at least `least`.
double lowerQuartile(std::vector<double> numbers, double least) {
    std::ranges::sort(numbers);
    return std::max(numbers[numbers.size() / 4], least);
}

/// A finding for each step of a channel that has samples, with its test. `lengths`: of the steps, by their mean.
std::vector<Finding> testedSteps(const std::vector<StepChange>& steps, const std::vector<double>& lengths,
                                 int channel) {
    double sum = 0, squares = 0, n = 0, largest = 0;
    std::vector<double> all, rates;
    std::vector<float> series;
    const auto rateOf = [&](std::size_t k) { return steps[k].square / (lengths[k] * lengths[k]); };
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const StepChange& each = steps[k];
        sum += each.sum, squares += each.sumSquares, n += each.values;
        largest = std::max(largest, each.largest);
        series.push_back(each.samples > 0 ? float(std::sqrt(each.square)) : std::nanf(""));
        if (each.samples == 0) continue;
        all.push_back(each.square);
        rates.push_back(rateOf(k));
    }
    if (all.size() < 2) return {};
    const double spread = n > 0 ? 3.29 * std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n))) : 0;
    const double rounding = 1e-6 * largest;
    const double usual = lowerQuartile(all, rounding * rounding), usualRate = lowerQuartile(rates, rounding * rounding);
    std::vector<Finding> out;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const StepChange& step = steps[k];
        if (step.samples == 0) continue;
        Finding one{.kind = FindingKind::Change, .x = channel, .region = step.region};
        one.number = step.signedMean;
        one.other = std::sqrt(usual);
        one.samples = step.samples, one.effective = step.effective;
        one.place = step.place;
        one.time = one.last = int(k) + 1;
        one.first = int(k);
        one.series = series;
        const double share = spread > 0 ? step.block / spread : 0, fast = share / lengths[k];
        one.strength = fast / (1 + fast);
        // The logarithm of a mean of n squares has the variance 2 / n; the quartile lies 0.67 deviations low.
        const double deviation = std::sqrt(2 / std::max(2.0, step.effective));
        const double log =
            usual > 0 && step.square > 0 ? std::log(std::min(step.square / usual, rateOf(k) / usualRate)) : 0;
        one.p = share > 0.02 ? normalTails(std::max(0.0, log - 0.67 * deviation) / (1.3 * deviation)) : 1;
        out.push_back(one);
    }
    return out;
}

/// Lengths of the steps of time, by their mean.
std::vector<double> stepLengths(const std::vector<double>& times) {
    const double mean = (times.back() - times.front()) / double(times.size() - 1);
    std::vector<double> lengths;
    for (std::size_t t = 1; t < times.size(); ++t) {
        const double length = (times[t] - times[t - 1]) / mean;
        lengths.push_back(length > 0 ? length : 1);
    }
    return lengths;
}

} // namespace

Changes findChanges(const BrickSource& source, const ChangesQuery& query, const Progress& progress) {
    Changes out;
    const std::size_t times = source.info().times.size();
    if (times < 3) return out;
    WorthSamplesQuery asked{.channels = query.channels, .level = query.level, .label = query.label};
    asked.doiChannels = query.doiChannels;
    asked.doi = query.doi;
    std::vector<std::vector<StepChange>> steps(query.channels.size(), std::vector<StepChange>(times - 1));
    WorthSamples before = readWorthSamples(source, asked);
    keepInside(before);
    std::vector<std::uint8_t> seen = anyPresent(before);
    for (std::size_t t = 1; t < times; ++t) {
        progress.advance(double(t) / double(times), "changes");
        asked.time = int(t);
        WorthSamples now = readWorthSamples(source, asked, {{}, progress.stop});
        keepInside(now);
        const std::vector<std::uint8_t> present = anyPresent(now);
        for (std::size_t i = 0; i < seen.size(); ++i) seen[i] |= present[i];
        parallelFor(query.channels.size(), [&](std::size_t c) { steps[c][t - 1] = stepChangeOf(before, now, c); });
        before = std::move(now);
    }
    out.samples = double(std::ranges::count(seen, 1));
    const std::vector<double> lengths = stepLengths(source.info().times);
    for (std::size_t c = 0; c < steps.size(); ++c)
        for (const Finding& each : testedSteps(steps[c], lengths, query.channels[c])) out.findings.add(each);
    progress.advance(1, "changes");
    return out;
}

std::vector<Finding> joinedSteps(std::vector<Finding> steps) {
    std::ranges::stable_sort(
        steps, [](const Finding& a, const Finding& b) { return a.x != b.x ? a.x < b.x : a.first < b.first; });
    std::vector<Finding> runs;
    for (const Finding& each : steps) {
        if (runs.empty() || runs.back().x != each.x || runs.back().last != each.first) {
            runs.push_back(each);
            continue;
        }
        Finding& run = runs.back();
        run.last = each.last;
        if (each.p < run.p) {
            run.p = each.p, run.q = each.q;
            run.samples = each.samples, run.effective = each.effective;
        }
        if (each.strength > run.strength) {
            run.strength = each.strength;
            run.time = each.time;
            run.number = each.number;
        }
    }
    std::ranges::stable_sort(runs, [](const Finding& a, const Finding& b) { return a.strength > b.strength; });
    return runs;
}

} // namespace tessera::volume
