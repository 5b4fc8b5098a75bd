#include "volume/worth/effective_samples.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

constexpr std::array kLags{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256};

struct Moments3 {
    double n = 0, mean = 0, variance = 0;
};

/// Products of samples `lag` apart along an axis, from the means, of all and of each region.
struct LagSums {
    std::vector<double> product, pairs;
};

LagSums sumsAt(const WorthSamples& samples, const std::vector<float>& values, const std::vector<Moments3>& moments,
               int axis, int lag) {
    LagSums sums{std::vector<double>(moments.size()), std::vector<double>(moments.size())};
    const std::size_t step = samples.step(axis) * std::size_t(lag);
    for (std::size_t i = 0; i + step < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        const std::size_t j = i + step;
        // Along x and y the end of a line is followed by the next one.
        if (axis < 2) {
            const std::size_t row = axis == 0 ? std::size_t(samples.size.x) : samples.step(2);
            if (i / row != j / row) continue;
        }
        if (std::isnan(values[j])) continue;
        const double a = double(values[i]), b = double(values[j]);
        sums.product[0] += (a - moments[0].mean) * (b - moments[0].mean);
        sums.pairs[0] += 1;
        if (samples.group.empty() || samples.group[i] == 0 || samples.group[i] != samples.group[j]) continue;
        const std::size_t g = samples.group[i];
        sums.product[g] += (a - moments[g].mean) * (b - moments[g].mean);
        sums.pairs[g] += 1;
    }
    return sums;
}

double lagAt(const std::vector<double>& lags, int k) {
    if (k == 0) return 1;
    for (std::size_t i = 0; i < lags.size(); ++i)
        if (k <= kLags[i]) {
            const int before = i == 0 ? 0 : kLags[i - 1];
            const double from = i == 0 ? 1 : lags[i - 1];
            return from + (lags[i] - from) * double(k - before) / double(kLags[i] - before);
        }
    return 0;
}

} // namespace

std::vector<Correlogram> correlograms(const WorthSamples& samples, const std::vector<float>& values) {
    const std::size_t groups = samples.regions.size() + 1;
    std::vector<Moments3> moments(groups);
    std::vector<Correlogram> all(groups);
    std::vector<glm::ivec3> lo(groups, samples.size), hi(groups, glm::ivec3(-1));
    const auto forGroups = [&](std::size_t i, auto&& visit) {
        if (std::isnan(values[i])) return;
        visit(std::size_t(0));
        if (!samples.group.empty() && samples.group[i] > 0) visit(std::size_t(samples.group[i]));
    };
    for (std::size_t i = 0; i < values.size(); ++i)
        forGroups(i, [&](std::size_t g) {
            moments[g].n += 1;
            moments[g].mean += (double(values[i]) - moments[g].mean) / moments[g].n;
            const glm::ivec3 at = samples.indexOf(i);
            for (int axis = 0; axis < 3; ++axis) {
                lo[g][axis] = std::min(lo[g][axis], at[axis]);
                hi[g][axis] = std::max(hi[g][axis], at[axis]);
            }
        });
    for (std::size_t i = 0; i < values.size(); ++i)
        forGroups(i, [&](std::size_t g) {
            const double away = double(values[i]) - moments[g].mean;
            moments[g].variance += away * away / moments[g].n;
        });
    std::vector<LagSums> sums(3 * kLags.size());
    parallelFor(sums.size(), [&](std::size_t i) {
        const int axis = int(i / kLags.size()), lag = kLags[i % kLags.size()];
        if (lag < samples.size[axis]) sums[i] = sumsAt(samples, values, moments, axis, lag);
    });
    for (std::size_t g = 0; g < groups; ++g) {
        all[g].samples = moments[g].n;
        for (int axis = 0; axis < 3; ++axis) {
            all[g].extent[std::size_t(axis)] = std::max(1, hi[g][axis] - lo[g][axis] + 1);
            for (std::size_t k = 0; k < kLags.size(); ++k) {
                const LagSums& at = sums[std::size_t(axis) * kLags.size() + k];
                if (at.pairs.empty() || at.pairs[g] == 0 || kLags[k] >= all[g].extent[std::size_t(axis)]) break;
                const double variance = moments[g].variance;
                all[g].lags[std::size_t(axis)].push_back(variance > 0 ? at.product[g] / at.pairs[g] / variance : 0);
            }
        }
    }
    return all;
}

std::array<double, 3> correlationLengths(const Correlogram& x, const Correlogram& y, bool second) {
    std::array<double, 3> lengths{1, 1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int extent = std::max(x.extent[axis], y.extent[axis]);
        for (int k = 1; k < extent; ++k) {
            const double a = lagAt(x.lags[axis], k), b = lagAt(y.lags[axis], k);
            if (a <= 0 || b <= 0) break;
            lengths[axis] += 2 * a * (second ? b : 1) * (1 - double(k) / extent);
        }
        lengths[axis] = std::clamp(lengths[axis], 1.0, double(extent));
    }
    return lengths;
}

double effectiveSamples(double samples, const std::array<double, 3>& lengths) {
    return std::max(1.0, samples / (lengths[0] * lengths[1] * lengths[2]));
}

} // namespace tessera::volume
