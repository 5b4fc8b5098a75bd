#include "volume/worth/differs.h"

#include "volume/base/parallel.h"
#include "volume/worth/effective_samples.h"
#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

constexpr double kLeastPart = 20; ///< samples on either side

struct SideValues {
    std::vector<float> values;
    double mean = 0, deviation = 0;

    void measure() {
        double sum = 0, squares = 0;
        for (const float value : values) sum += double(value);
        mean = sum / double(values.size());
        for (const float value : values) squares += (double(value) - mean) * (double(value) - mean);
        deviation = std::sqrt(squares / double(values.size()));
    }
};

/// What is selected as 1 and the rest as 0, where `values` are.
std::vector<float> selectedOnes(const WorthSamples& samples, const std::vector<float>& values) {
    std::vector<float> out(samples.inside.begin(), samples.inside.end());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isnan(values[i])) out[i] = values[i];
    return out;
}

/// Independent samples of a covariance of two, whatever their region.
double effectiveOf(const WorthSamples& samples, const std::vector<float>& a, const std::vector<float>& b, double n) {
    constexpr double kShorter = 0.85; // as of dependences
    WorthSamples plain;
    plain.size = samples.size;
    return kShorter *
           effectiveSamples(n, correlationLengths(correlograms(plain, a).front(), correlograms(plain, b).front()));
}

/// Pearson's r of an selectedOnes, 1 for a share of all samples, with what has these means there and in the rest.
double indicatorCorrelation(double share, double inside, double outside, double deviation) {
    return deviation > 0 ? std::clamp((inside - outside) * std::sqrt(share * (1 - share)) / deviation, -1.0, 1.0)
                         : std::nan("");
}

std::optional<Finding> differenceOf(const WorthSamples& samples, std::size_t channel) {
    SideValues in, out, all;
    const std::vector<float>& values = samples.values[channel];
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        all.values.push_back(values[i]);
        (samples.inside[i] != 0 ? in : out).values.push_back(values[i]);
    }
    if (double(in.values.size()) < kLeastPart || double(out.values.size()) < kLeastPart) return std::nullopt;
    for (SideValues* each : {&in, &out, &all}) each->measure();
    const double n = double(all.values.size()), share = double(in.values.size()) / n;
    const double effective = effectiveOf(samples, values, selectedOnes(samples, values), n);
    Finding one{.kind = FindingKind::Differs, .x = samples.channels[channel], .number = in.mean, .other = out.mean};
    one.samples = double(in.values.size());
    one.effective = std::max(1.0, share * effective);
    const double distance = kolmogorovDistance(in.values, out.values);
    one.strength = distance;
    const double shape = kolmogorovTail(distance, effective * share * (1 - share));
    const double level = correlationTail(indicatorCorrelation(share, in.mean, out.mean, all.deviation), effective);
    one.p = std::min(1.0, 2 * std::min(shape, level));
    return one;
}

void addRegions(const WorthSamples& samples, Findings& out) {
    if (samples.regions.size() < 2) return;
    // What is void is neither selected nor the rest.
    std::vector<float> there(samples.count(), 0);
    const std::vector<std::uint8_t> present = anyPresent(samples);
    for (std::size_t i = 0; i < there.size(); ++i)
        if (present[i] == 0 && samples.group[i] == 0) there[i] = std::nanf("");
    const std::vector<float> selected = selectedOnes(samples, there);
    double n = 0, chosen = 0;
    for (const float each : selected)
        if (!std::isnan(each)) n += 1, chosen += double(each);
    if (chosen < kLeastPart || n - chosen < kLeastPart) return;
    std::optional<Finding> best; // their shares hang together
    for (std::size_t g = 1; g <= samples.regions.size(); ++g) {
        std::vector<float> region = there;
        double both = 0, all = 0;
        for (std::size_t i = 0; i < region.size(); ++i) {
            if (std::isnan(there[i])) continue;
            region[i] = samples.group[i] == g ? 1.0f : 0.0f;
            all += double(region[i]);
            both += double(region[i]) * double(selected[i]);
        }
        const double share = all / n, effective = effectiveOf(samples, region, selected, n);
        Finding one{.kind = FindingKind::Region, .region = samples.regions[g - 1]};
        one.number = both / chosen;
        one.other = (all - both) / (n - chosen);
        one.strength = std::abs(one.number - one.other);
        one.samples = chosen, one.effective = std::max(1.0, effective * chosen / n);
        one.p = correlationTail(indicatorCorrelation(chosen / n, one.number, one.other, std::sqrt(share * (1 - share))),
                                effective);
        one.p = std::min(1.0, one.p * double(samples.regions.size()));
        if (!best || one.p < best->p) best = one;
    }
    if (best) out.add(*best);
}

/// Chance that numbers in random order follow each other as closely as these, or more, by the squares of the steps of
/// their ranks (R. Bartels, The rank version of von Neumann's ratio test for randomness, 1982); 1 of fewer than 8.
double orderTail(const std::vector<double>& numbers) {
    const std::size_t n = numbers.size();
    if (n < 8) return 1;
    std::vector<double> ranks;
    for (const double each : numbers) { // ties have the middle of their ranks
        double below = 0, same = 0;
        for (const double other : numbers) below += other < each ? 1 : 0, same += other == each ? 1 : 0;
        ranks.push_back(below + (same + 1) / 2);
    }
    double steps = 0, squares = 0;
    const double t = double(n), middle = (t + 1) / 2;
    for (std::size_t i = 0; i < n; ++i) {
        squares += (ranks[i] - middle) * (ranks[i] - middle);
        if (i > 0) steps += (ranks[i] - ranks[i - 1]) * (ranks[i] - ranks[i - 1]);
    }
    if (squares <= 0) return 1;
    const double variance = 4 * (t - 2) * (5 * t * t - 2 * t - 9) / (5 * t * (t + 1) * (t - 1) * (t - 1));
    const double z = (2 - steps / squares) / std::sqrt(variance);
    return z > 0 ? normalTails(z) / 2 : 1;
}

} // namespace

double kolmogorovDistance(std::vector<float>& a, std::vector<float>& b) {
    std::ranges::sort(a);
    std::ranges::sort(b);
    double distance = 0;
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        const float value = std::min(a[i], b[j]);
        while (i < a.size() && a[i] <= value) ++i;
        while (j < b.size() && b[j] <= value) ++j;
        distance = std::max(distance, std::abs(double(i) / double(a.size()) - double(j) / double(b.size())));
    }
    return distance;
}

Findings findDifferences(const WorthSamples& samples, std::span<const int> without, const Progress& progress) {
    Findings out;
    if (samples.inside.empty()) return out;
    std::vector<std::optional<Finding>> found(samples.values.size());
    progress.advance(0, "differences");
    parallelFor(found.size(), [&](std::size_t c) {
        if (progress.stop.stop_requested()) throw Cancelled();
        if (std::ranges::find(without, samples.channels[c]) == without.end()) found[c] = differenceOf(samples, c);
    });
    for (const std::optional<Finding>& each : found)
        if (each) out.add(*each);
    addRegions(samples, out);
    progress.advance(1, "differences");
    return out;
}

Findings findSelectedTimes(const BrickSource& source, const SelectedTimesQuery& query, const Progress& progress) {
    Findings out;
    const std::size_t times = source.info().times.size();
    if (times < 2 || !query.doi) return out;
    std::vector<double> shares; // of the times with samples
    double sum = 0;
    Finding one{.kind = FindingKind::Time};
    for (std::size_t t = 0; t < times; ++t) {
        progress.advance(double(t) / double(times), "times");
        const WorthSamplesQuery asked{.channels = query.channels,
                                      .time = int(t),
                                      .level = query.level,
                                      .doiChannels = query.doiChannels,
                                      .doi = query.doi};
        const WorthSamples samples = readWorthSamples(source, asked, {{}, progress.stop});
        const std::vector<std::uint8_t> present = anyPresent(samples);
        double n = 0, inside = 0;
        for (std::size_t i = 0; i < present.size(); ++i)
            if (present[i] != 0) n += 1, inside += samples.inside[i];
        one.series.push_back(n > 0 ? float(inside / n) : std::nanf(""));
        if (n == 0) continue;
        if (shares.empty() || inside / n > one.number) {
            one.number = inside / n;
            one.samples = inside;
            one.time = one.first = one.last = int(t);
        }
        shares.push_back(inside / n);
        sum += shares.back();
    }
    progress.advance(1, "times");
    if (shares.size() < 2 || one.number - *std::ranges::min_element(shares) < 1e-12) return out;
    one.other = (sum - one.number) / double(shares.size() - 1);
    one.strength = (one.number - one.other) / one.number;
    one.effective = double(shares.size());
    one.p = orderTail(shares);
    out.add(one);
    return out;
}

} // namespace tessera::volume
