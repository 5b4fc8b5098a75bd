#include "volume/worth/dependence.h"

#include "volume/base/parallel.h"
#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tessera::volume {

namespace {

constexpr std::size_t kMostPoints = 400; ///< of a distance correlation
constexpr double kFewest = 4;            ///< independent samples of r that are tested
/// Lengths come from the same samples, and are too short where a field is as large as they are.
constexpr double kCautious = 0.85;
constexpr double kFewestPoints = 12; ///< of a distance correlation

struct CorrelationSums {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    void add(double a, double b) { n += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
    CorrelationSums without(const CorrelationSums& part) const {
        return {n - part.n, x - part.x, y - part.y, xx - part.xx, yy - part.yy, xy - part.xy};
    }
    double r() const {
        const double sx = xx - x * x / n, sy = yy - y * y / n, tiny = 1e-9;
        if (n < 4 || sx <= tiny * xx || sy <= tiny * yy) return std::nan("");
        return std::clamp((xy - x * y / n) / std::sqrt(sx * sy), -1.0, 1.0);
    }
};

/// 32-bit hash of a number (SplitMix64's finaliser).
std::uint32_t spreadHash(std::uint64_t x) {
    x = (x + 0x9e3779b97f4a7c15ull) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return std::uint32_t((x ^ x >> 31) >> 16);
}

struct PairPoints {
    std::vector<double> x, y;
};

/// A sample of every block of the size of the correlation lengths, by a hash; at most so many.
PairPoints pointsApart(const WorthSamples& samples, std::size_t a, std::size_t b, std::size_t group,
                       const std::array<double, 3>& lengths, std::size_t most) {
    glm::ivec3 block, blocks;
    for (int axis = 0; axis < 3; ++axis) {
        block[axis] = int(std::ceil(lengths[std::size_t(axis)]));
        blocks[axis] = (samples.size[axis] + block[axis] - 1) / block[axis];
    }
    struct Chosen {
        std::uint32_t hash = 0;
        std::size_t sample = std::size_t(-1);
    };
    std::map<std::size_t, Chosen> chosen;
    const std::vector<float>&x = samples.values[a], &y = samples.values[b];
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(x[i]) || std::isnan(y[i]) || !samples.isIn(i, group)) continue;
        const glm::ivec3 at = samples.indexOf(i) / block;
        const std::size_t number =
            (std::size_t(at.z) * std::size_t(blocks.y) + std::size_t(at.y)) * std::size_t(blocks.x) + std::size_t(at.x);
        Chosen& of = chosen[number];
        if (const std::uint32_t hash = spreadHash(i); of.sample == std::size_t(-1) || hash < of.hash) of = {hash, i};
    }
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    for (const auto& [number, of] : chosen) order.emplace_back(spreadHash(number + 77), of.sample);
    std::ranges::sort(order);
    PairPoints points;
    for (std::size_t i = 0; i < std::min(order.size(), most); ++i) {
        points.x.push_back(double(x[order[i].second]));
        points.y.push_back(double(y[order[i].second]));
    }
    return points;
}

/// Distances of all pairs, U-centred: rows and columns sum to 0.
std::vector<double> centredDistances(std::span<const double> x) {
    const std::size_t n = x.size();
    std::vector<double> out(n * n), rows(n);
    double all = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) rows[i] += out[i * n + j] = std::abs(x[i] - x[j]);
    for (const double row : rows) all += row;
    const double count = double(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            out[i * n + j] =
                i == j ? 0 : out[i * n + j] - (rows[i] + rows[j]) / (count - 2) + all / ((count - 1) * (count - 2));
    return out;
}

/// All that is known of a pair of channels.
struct PairNumbers {
    std::vector<CorrelationSums> sums; ///< [0]: all, [1 + region]
    std::vector<double> effective;     ///< of each
    std::vector<double> distance;      ///< squared distance correlation of each, NaN where not computed
    std::vector<double> points;        ///< that it is of
};

PairNumbers numbersOf(const WorthSamples& samples, const std::vector<std::vector<Correlogram>>& lags, std::size_t a,
                      std::size_t b) {
    const std::size_t groups = samples.regions.size() + 1;
    PairNumbers out{std::vector<CorrelationSums>(groups), std::vector<double>(groups), std::vector<double>(groups),
                    std::vector<double>(groups)};
    const std::vector<float>&x = samples.values[a], &y = samples.values[b];
    double shiftX = std::nan(""), shiftY = 0; // near the values, so that squares keep their digits
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(x[i]) || std::isnan(y[i])) continue;
        if (std::isnan(shiftX)) shiftX = double(x[i]), shiftY = double(y[i]);
        const double u = double(x[i]) - shiftX, v = double(y[i]) - shiftY;
        out.sums[0].add(u, v);
        if (!samples.group.empty() && samples.group[i] > 0) out.sums[samples.group[i]].add(u, v);
    }
    for (std::size_t g = 0; g < groups; ++g) {
        out.distance[g] = std::nan("");
        const std::array<double, 3> lengths = correlationLengths(lags[a][g], lags[b][g]);
        out.effective[g] = kCautious * effectiveSamples(out.sums[g].n, lengths);
        if (out.effective[g] < kFewest || std::isnan(out.sums[g].r())) continue;
        const PairPoints points =
            pointsApart(samples, a, b, g, lengths, std::min(kMostPoints, std::size_t(out.effective[g])));
        out.points[g] = double(points.x.size());
        if (out.points[g] >= kFewestPoints) out.distance[g] = distanceCorrelation(points.x, points.y);
    }
    return out;
}

/// Tests of a pair: of r and of distances for each group with enough samples, and of r in a region against elsewhere.
Findings testsOf(const WorthSamples& samples, const PairNumbers& numbers, int x, int y) {
    Findings out;
    for (std::size_t g = 0; g < numbers.sums.size(); ++g) {
        const double r = numbers.sums[g].r(), n = numbers.effective[g];
        if (std::isnan(r) || n < kFewest) continue;
        // One region alone is all there is.
        if (g > 0 && numbers.sums[g].n > 0.95 * numbers.sums[0].n) continue;
        Finding one{.kind = FindingKind::Dependence, .x = x, .y = y, .number = r, .strength = std::abs(r)};
        if (g > 0) one.region = samples.regions[g - 1];
        one.samples = numbers.sums[g].n;
        one.effective = n;
        one.p = correlationTail(r, n);
        out.add(one);
        if (!std::isnan(numbers.distance[g])) {
            const double distance = std::sqrt(std::max(0.0, numbers.distance[g]));
            Finding curved = one;
            curved.kind = FindingKind::Nonlinear;
            curved.number = distance, curved.other = r;
            curved.strength = distance;
            curved.effective = numbers.points[g];
            curved.p = distanceTail(numbers.points[g] * numbers.distance[g]);
            out.add(curved);
        }
        const double elsewhere = g > 0 ? numbers.sums[0].without(numbers.sums[g]).r() : std::nan("");
        const double rest = numbers.effective[0] * (1 - numbers.sums[g].n / numbers.sums[0].n);
        if (std::isnan(elsewhere) || rest < kFewest) continue;
        const auto fisher = [](double of) { return std::atanh(std::clamp(of, -0.999999, 0.999999)); };
        Finding contrast = one;
        contrast.kind = FindingKind::Contrast;
        contrast.other = elsewhere;
        contrast.strength = std::abs(r - elsewhere) / 2;
        contrast.p = normalTails((fisher(r) - fisher(elsewhere)) / std::sqrt(1 / (n - 3) + 1 / (rest - 3)));
        out.add(contrast);
    }
    return out;
}

} // namespace

double distanceCorrelation(std::span<const double> x, std::span<const double> y) {
    const std::size_t n = x.size();
    if (n < 4) return std::nan("");
    const std::vector<double> a = centredDistances(x), b = centredDistances(y);
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : std::nan("");
}

Findings findDependences(const WorthSamples& samples, const Progress& progress) {
    const std::size_t channels = samples.values.size();
    std::vector<std::vector<Correlogram>> lags(channels);
    progress.advance(0, "correlation lengths");
    for (std::size_t c = 0; c < channels; ++c) {
        lags[c] = correlograms(samples, samples.values[c]);
        progress.advance(0.6 * double(c + 1) / double(channels), "correlation lengths");
    }
    std::vector<std::array<std::size_t, 2>> pairs;
    for (std::size_t b = 1; b < channels; ++b)
        for (std::size_t a = 0; a < b; ++a) pairs.push_back({a, b});
    std::vector<Findings> tests(pairs.size());
    parallelFor(pairs.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const auto [a, b] = pairs[i];
        tests[i] = testsOf(samples, numbersOf(samples, lags, a, b), samples.channels[a], samples.channels[b]);
    });
    progress.advance(1, "dependences");
    Findings all;
    for (const Findings& each : tests) {
        all.tests += each.tests;
        all.found.insert(all.found.end(), each.found.begin(), each.found.end());
    }
    return all;
}

} // namespace tessera::volume
