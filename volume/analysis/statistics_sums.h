#pragma once

#include "volume/analysis/statistics_results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// Partial sums and histograms, merged in fixed order or independent of it: internal to volume/analysis/statistics.cpp.
namespace tessera::volume {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr int kFocusBits = 10;  // interest is summed in units of 2^-10: integers add up the same in any order
inline constexpr int kCountShift = 36; // a packed bin: count above, focus below
inline constexpr std::size_t kFlush = std::size_t(1) << (kCountShift - kFocusBits); // samples that fit a packed bin

/// Values of one channel in one brick, ready to be summed.
struct Column {
    std::vector<float> value;       ///< physical; NaN where absent
    std::vector<float> rest;        ///< BrickSamples::rest
    std::vector<float> centred;     ///< less the channel's shift; 0 where absent
    std::vector<float> present;     ///< 1 or 0
    std::vector<std::uint16_t> bin; ///< the number of bins where absent or out of range
    bool whole = true;              ///< every sample is present

    double exact(std::size_t i) const { return rest.empty() ? double(value[i]) : double(value[i]) + double(rest[i]); }
};

/// A range of samples [begin, end) of a brick, with their weights (null: all 1).
struct Stretch {
    std::size_t begin, end;
    const float* weight;
    double weightOf(std::size_t i) const { return weight != nullptr ? double(weight[i]) : 1.0; }
};

/// N sums over a stretch, in eight independent lanes, so that the compiler can vectorise without changing the result;
/// `addTo(i, lanes, lane)` adds sample i to lanes[n][lane].
template <std::size_t N> std::array<double, N> laneSums(const Stretch& stretch, const auto& addTo) {
    constexpr std::size_t kLanes = 8;
    double lanes[N][kLanes] = {};
    std::size_t i = stretch.begin;
    for (; i + kLanes <= stretch.end; i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) addTo(i + lane, lanes, lane);
    for (; i < stretch.end; ++i) addTo(i, lanes, 0);
    std::array<double, N> sums{};
    for (std::size_t n = 0; n < N; ++n)
        for (const double lane : lanes[n]) sums[n] += lane;
    return sums;
}

/// Weight, sum and sum of squares of a column that is whole.
struct Moments {
    double n = 0, sum = 0, squares = 0;

    static Moments of(const Column& column, const Stretch& stretch) {
        const auto [n, sum, squares] = laneSums<3>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double w = stretch.weightOf(i), v = double(column.centred[i]);
            lanes[0][lane] += w;
            lanes[1][lane] += w * v;
            lanes[2][lane] += w * (v * v);
        });
        return {n, sum, squares};
    }
};

/// Weighted sums of one channel over a set of samples, relative to a shift so that close values keep their digits.
struct Sums {
    double n = 0, volume = 0, sum = 0, squares = 0, integral = 0;
    double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();

    void add(double value, double shift, double cell, double weight) {
        if (weight <= 0) return;
        const double v = value - shift;
        n += weight;
        volume += weight * cell;
        sum += weight * v;
        squares += weight * v * v;
        integral += weight * cell * v;
        if (weight < 0.5) return;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    /// All of a whole column without a rest with weight 1; `cells`: the volume of each sample, `volumes`: of all
    /// together.
    void add(const Column& column, double shift, std::span<const double> cells, double volumes) {
        const Stretch all{0, column.value.size(), nullptr};
        const auto [first, second, third] = laneSums<3>(all, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double v = double(column.value[i]) - shift;
            lanes[0][lane] += v;
            lanes[1][lane] += v * v;
            lanes[2][lane] += v * cells[i];
        });
        n += double(column.value.size());
        volume += volumes;
        sum += first;
        squares += second;
        integral += third;
        float least = std::numeric_limits<float>::infinity(), most = -least;
        for (const float value : column.value) {
            least = std::min(least, value);
            most = std::max(most, value);
        }
        min = std::min(min, double(least));
        max = std::max(max, double(most));
    }
    void add(const Sums& other) {
        n += other.n;
        volume += other.volume;
        sum += other.sum;
        squares += other.squares;
        integral += other.integral;
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
    Summary summary(double shift) const {
        if (n <= 0) return {0, 0, kNan, kNan, kNan, kNan, 0};
        const double mean = sum / n;
        const double variance = std::max(0.0, squares / n - mean * mean);
        const bool any = min <= max;
        return {n,
                volume,
                shift + mean,
                std::sqrt(variance),
                any ? min : kNan,
                any ? max : kNan,
                shift * volume + integral};
    }
};

/// Sums of a pair of channels over samples present in both.
struct PairSums {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

    /// Adds a stretch. For complete columns only the products are computed; the rest is taken from their moments.
    void add(const Column& a, const Column& b, const Moments& ofA, const Moments& ofB, const Stretch& stretch) {
        if (a.whole && b.whole) {
            n += ofA.n;
            x += ofA.sum;
            y += ofB.sum;
            xx += ofA.squares;
            yy += ofB.squares;
            xy += laneSums<1>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
                lanes[0][lane] += stretch.weightOf(i) * (double(a.centred[i]) * double(b.centred[i]));
            })[0];
            return;
        }
        const auto sums = laneSums<6>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double w = stretch.weightOf(i);
            const double u = double(a.centred[i]), v = double(b.centred[i]);
            const double p = double(a.present[i]) * w, q = double(b.present[i]) * w;
            lanes[0][lane] += double(a.present[i]) * q;
            lanes[1][lane] += u * q;
            lanes[2][lane] += v * p;
            lanes[3][lane] += u * u * q;
            lanes[4][lane] += v * v * p;
            lanes[5][lane] += u * v * w;
        });
        add({sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]});
    }
    void add(const PairSums& other) {
        n += other.n;
        x += other.x;
        y += other.y;
        xx += other.xx;
        yy += other.yy;
        xy += other.xy;
    }
    PairSums without(const PairSums& part) const {
        return {n - part.n, x - part.x, y - part.y, xx - part.xx, yy - part.yy, xy - part.xy};
    }
    double correlation() const {
        const double a = n * xx - x * x, b = n * yy - y * y;
        // What rounding leaves of a constant channel is no variance.
        constexpr double kEpsilon = 1e-12;
        if (n < 2 || a <= kEpsilon * n * xx || b <= kEpsilon * n * yy) return kNan;
        return std::clamp((n * xy - x * y) / std::sqrt(a * b), -1.0, 1.0);
    }
};

/// Sums of one brick, besides histograms; merged in the order of the bricks.
struct BrickSums {
    std::vector<Sums> inside, outside; ///< per channel
    std::vector<PairSums> pairs, focusPairs;
};

/// Histograms being accumulated: `packed` takes samples fast, the others are exact for any number of them.
struct Bins {
    std::vector<std::uint64_t> packed, count, focus;
    std::vector<std::uint64_t> third, thirdCount; ///< sum in units of a channel's range / 65535, and how many; or empty
    explicit Bins(std::size_t size = 0, bool withThird = false)
        : packed(size), count(size), focus(size), third(withThird ? size : 0), thirdCount(third.size()) {}

    void flush() {
        for (std::size_t i = 0; i < packed.size(); ++i) {
            count[i] += packed[i] >> kCountShift;
            focus[i] += packed[i] & ((std::uint64_t(1) << kCountShift) - 1);
            packed[i] = 0;
        }
    }
    void add(const Bins& flushed) {
        for (std::size_t i = 0; i < count.size(); ++i) {
            count[i] += flushed.count[i];
            focus[i] += flushed.focus[i];
        }
        for (std::size_t i = 0; i < third.size(); ++i) {
            third[i] += flushed.third[i];
            thirdCount[i] += flushed.thirdCount[i];
        }
    }
};

/// The histograms of one thread. Each axis has one extra bin for values that belong in none.
struct BinSet {
    std::vector<Bins> channels, pairs;
    std::size_t samples = 0; ///< since the last flush

    void flush() {
        for (Bins& bins : channels) bins.flush();
        for (Bins& bins : pairs) bins.flush();
        samples = 0;
    }
};

/// Focus 1 and count 1 of a sample in a packed bin.
inline std::uint64_t packedSample(double doi) {
    return (std::uint64_t(1) << kCountShift) + std::uint64_t(std::lround(doi * (1 << kFocusBits)));
}

} // namespace tessera::volume
