#include "volume/worth/significance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume {

namespace {

/// The continued fraction of the incomplete beta function (NIST Handbook of Mathematical Functions, 8.17.22).
double betaFraction(double a, double b, double x) {
    constexpr double kTiny = 1e-300;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    double value = d;
    for (int m = 1; m <= 300; ++m) {
        for (const bool odd : {false, true}) {
            const double term = odd ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                                    : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
            d = 1 + term * d;
            c = 1 + term / c;
            d = 1 / (std::abs(d) < kTiny ? kTiny : d);
            if (std::abs(c) < kTiny) c = kTiny;
            value *= c * d;
            if (odd && std::abs(c * d - 1) < 1e-14) return value;
        }
    }
    return value;
}

/// The regularised incomplete beta function I_x(a, b).
double incompleteBeta(double a, double b, double x) {
    if (!(x > 0)) return 0;
    if (x >= 1) return 1;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * betaFraction(a, b, x) / a : 1 - front * betaFraction(b, a, 1 - x) / b;
}

} // namespace

double normalTails(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double studentTails(double t, double freedom) {
    if (!(freedom > 0)) return 1;
    return std::isinf(t) ? 0 : incompleteBeta(freedom / 2, 0.5, freedom / (freedom + t * t));
}

double distanceTail(double x) {
    return x <= -1 ? 1 : std::erfc(std::sqrt((x + 1) / 2));
}

double kolmogorovTail(double distance, double samples) {
    if (!(samples > 0)) return 1;
    const double root = std::sqrt(samples), z = distance * (root + 0.12 + 0.11 / root);
    if (z < 0.3) return 1;
    double tail = 0;
    for (int k = 1; k <= 100; ++k) {
        const double term = 2 * (k % 2 == 1 ? 1 : -1) * std::exp(-2.0 * k * k * z * z);
        tail += term;
        if (std::abs(term) < 1e-16) break;
    }
    return std::clamp(tail, 0.0, 1.0);
}

double correlationTail(double r, double samples) {
    if (!(samples >= 4) || std::isnan(r)) return 1;
    const double rest = 1 - r * r;
    return rest <= 0 ? 0 : studentTails(r * std::sqrt((samples - 2) / rest), samples - 2);
}

double rankedQuantile(std::span<const float> sorted, double share) {
    return double(sorted[std::min(sorted.size() - 1, std::size_t(share * double(sorted.size())))]);
}

double expectedBeyond(std::span<const float> sorted, double value, double samples, double least) {
    if (sorted.empty()) return samples;
    const double median = rankedQuantile(sorted, 0.5), upper = rankedQuantile(sorted, 0.75);
    constexpr double kHeavier = 2;
    const double scale = std::max({kHeavier * (upper - median) / std::log(2.0), least, 1e-300});
    return value <= median ? samples : samples * 0.5 * std::exp(-(value - median) / scale);
}

std::vector<double> falseDiscoveryRates(std::span<const double> p) {
    const auto of = [&](std::size_t i) { return std::isnan(p[i]) ? 1.0 : p[i]; };
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return of(a) < of(b); });
    std::vector<double> rates(p.size(), 1.0);
    double least = 1;
    for (std::size_t k = p.size(); k-- > 0;) {
        least = std::min(least, of(order[k]) * double(p.size()) / double(k + 1));
        rates[order[k]] = least;
    }
    return rates;
}

} // namespace tessera::volume
