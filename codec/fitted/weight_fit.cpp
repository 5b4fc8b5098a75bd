#include "codec/fitted/weight_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tessera::codec {

namespace {

/// Fewer samples than this share the weights of the next class.
constexpr double kFewest = 200;
constexpr double kMostWeight = 8191;

/// Solves (products + ridge) * x = right, where products are an upper triangle, by Cholesky's method.
std::vector<double> solve(std::vector<double> matrix, std::size_t size, std::vector<double> right) {
    for (std::size_t i = 0; i < size; ++i) {
        const double pivot = matrix[i * size + i];
        if (!(pivot > 0)) return std::vector<double>(size, 0.0);
        for (std::size_t j = i + 1; j < size; ++j) {
            const double factor = matrix[i * size + j] / pivot;
            for (std::size_t k = j; k < size; ++k) matrix[j * size + k] -= factor * matrix[i * size + k];
            right[j] -= factor * right[i];
        }
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t j = i + 1; j < size; ++j) right[i] -= matrix[i * size + j] * right[j];
        right[i] /= matrix[i * size + i];
    }
    return right;
}

/// The weights of differences from the guess, and what is added, that fit best and are close to `usual`.
std::vector<double> fitted(const std::vector<double>& products, double count, std::size_t taps,
                           const std::vector<double>& usual) {
    // A little of a unit of noise, and of the taps' own size, holds back weights that the samples hardly determine.
    constexpr double kNoise = 1e-3, kSamples = 8;
    const std::size_t size = taps + 1, wide = taps + 2;
    double trace = 0;
    for (std::size_t i = 0; i < taps; ++i) trace += products[i * wide + i];
    const double ridge = kNoise * count + kSamples * trace / (double(taps) * count);
    std::vector<double> matrix(size * size), right(size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = i; j < size; ++j) matrix[i * size + j] = products[i * wide + j];
        matrix[i * size + i] += ridge;
        right[i] = products[i * wide + taps + 1] + ridge * usual[i];
    }
    return solve(std::move(matrix), size, std::move(right));
}

/// Weights of the samples themselves: the first two have what is left to a sum of 1.
std::vector<std::int32_t> wholeWeights(const std::vector<double>& fit) {
    const std::size_t taps = fit.size() - 1;
    constexpr int kOne = 1 << kWeightBits;
    const auto whole = [](double value) {
        return static_cast<std::int32_t>(std::lround(std::clamp(value * kOne, -kMostWeight, kMostWeight)));
    };
    std::vector<std::int32_t> weights(taps + 1);
    double rest = 1 - fit[0] - fit[1];
    std::int32_t sum = 0;
    for (std::size_t t = 2; t < taps; ++t) {
        weights[t] = whole(fit[t]);
        sum += weights[t];
        rest -= fit[t];
    }
    weights[0] = whole(fit[0] + rest / 2);
    weights[1] = std::clamp(kOne - sum - weights[0], int(-kMostWeight), int(kMostWeight));
    weights[taps] = whole(fit[taps]);
    return weights;
}

} // namespace

WeightFit::WeightFit() : sums_(std::size_t(kDepths) * kPasses * kActivityClasses) {}

template <class Word>
void WeightFit::add(int level, PassRows<Word>& rows, int z, int y, const Word* samples, int shift) {
    const TapSet& set = tapsOf(rows.pass());
    const TapRows<Word> taps = rows.taps(z, y);
    const auto count = static_cast<std::size_t>(set.count), wide = count + 2;
    Sums* const own = &sums_[FittedWeights::placeOf(level, rows.pass()) * kActivityClasses];
    std::array<double, kMostTaps + 2> f{};
    for (int x = 0; x < rows.count().x; ++x) {
        const std::int32_t guess = (std::int32_t(taps.at(0)[x]) + std::int32_t(taps.at(1)[x])) >> 1;
        std::uint32_t away = 0;
        for (std::size_t t = 0; t < count; ++t) {
            const std::int32_t apart = std::int32_t(taps.at(t)[x]) - guess;
            if (int(t) < set.near) away += static_cast<std::uint32_t>(std::abs(apart));
            f[t] = apart;
        }
        f[count] = 1;
        f[count + 1] = std::int32_t(samples[x]) - guess;
        Sums& sums = own[activityClass(away >> shift)];
        if (sums.products.empty()) sums.products.resize(wide * wide);
        sums.count += 1;
        for (std::size_t i = 0; i <= count; ++i) {
            if (f[i] == 0) continue;
            double* const row = &sums.products[i * wide];
            for (std::size_t j = i; j < wide; ++j) row[j] += f[i] * f[j];
        }
    }
}

void WeightFit::add(const WeightFit& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Sums& more = other.sums_[i];
        if (more.count == 0) continue;
        sums_[i].count += more.count;
        sums_[i].products.resize(more.products.size());
        for (std::size_t k = 0; k < more.products.size(); ++k) sums_[i].products[k] += more.products[k];
    }
}

FittedWeights WeightFit::solved() const {
    FittedWeights weights;
    for (std::size_t place = 0; place < weights.passes.size(); ++place) {
        PassWeights& own = weights.passes[place];
        own = plainWeights(static_cast<Pass>(place % kPasses));
        const auto taps = static_cast<std::size_t>(tapsOf(static_cast<Pass>(place % kPasses)).count);
        Sums all{0, std::vector<double>((taps + 2) * (taps + 2))};
        const Sums* const classes = &sums_[place * kActivityClasses];
        for (std::size_t c = 0; c < kActivityClasses; ++c) {
            all.count += classes[c].count;
            for (std::size_t k = 0; k < classes[c].products.size(); ++k) all.products[k] += classes[c].products[k];
        }
        if (all.count < kFewest) continue;
        const std::vector<double> usual = fitted(all.products, all.count, taps, std::vector<double>(taps + 1, 0.0));
        std::vector<double> last = usual;
        for (std::size_t c = 0; c < kActivityClasses; ++c)
            if (classes[c].count >= kFewest) {
                last = fitted(classes[c].products, classes[c].count, taps, usual);
                break;
            }
        for (std::size_t c = 0; c < kActivityClasses; ++c) {
            if (classes[c].count >= kFewest) last = fitted(classes[c].products, classes[c].count, taps, usual);
            setClass(wholeWeights(last), c, own);
        }
    }
    return weights;
}

template void WeightFit::add(int, PassRows<std::int16_t>&, int, int, const std::int16_t*, int);
template void WeightFit::add(int, PassRows<std::int32_t>&, int, int, const std::int32_t*, int);

} // namespace tessera::codec
