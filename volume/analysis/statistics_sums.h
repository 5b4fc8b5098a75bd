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
inline constexpr int kFocusBits = 10; // interest is summed in units of 2^-10: integers add up the same in any order
inline constexpr int kThirdBits = 46; // volumes are summed as integers, too: 16 bits of a value times 46
inline constexpr int kVolumeBits = 60;
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

/// A range of samples [begin, end) of a brick.
struct Stretch {
    std::size_t begin, end;
    const double* weight; ///< of every sample of the brick: the volume of its cell, times its degree of interest
    const float* share;   ///< the degree alone; null: all 1
    double shareOf(std::size_t i) const { return share != nullptr ? double(share[i]) : 1.0; }
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

/// Number, weight, sum and sum of squares of a column that is whole.
struct Moments {
    double samples = 0, n = 0, sum = 0, squares = 0;

    static Moments of(const Column& column, const Stretch& stretch) {
        const auto [samples, n, sum, squares] = laneSums<4>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double w = stretch.weight[i], v = double(column.centred[i]);
            lanes[0][lane] += stretch.shareOf(i);
            lanes[1][lane] += w;
            lanes[2][lane] += w * v;
            lanes[3][lane] += w * (v * v);
        });
        return {samples, n, sum, squares};
    }
};

/// Weighted sums of one channel over a set of samples, relative to a shift so that close values keep their digits;
/// values and their squares times the volume of their cells.
struct Sums {
    double n = 0, volume = 0, integral = 0, squares = 0;
    double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();

    void add(double value, double shift, double cell, double weight) {
        if (weight <= 0) return;
        const double v = value - shift;
        n += weight;
        volume += weight * cell;
        integral += weight * cell * v;
        squares += weight * cell * v * v;
        if (weight < 0.5) return;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    /// All of a whole column without a rest with weight 1; `cells`: the volume of each sample, `volumes`: of all
    /// together.
    void add(const Column& column, double shift, std::span<const double> cells, double volumes) {
        const Stretch all{0, column.value.size(), cells.data(), nullptr};
        const auto [first, second] = laneSums<2>(all, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double v = double(column.value[i]) - shift;
            lanes[0][lane] += v * cells[i];
            lanes[1][lane] += v * v * cells[i];
        });
        n += double(column.value.size());
        volume += volumes;
        integral += first;
        squares += second;
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
        integral += other.integral;
        squares += other.squares;
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
    Summary summary(double shift) const {
        if (n <= 0) return {0, 0, kNan, kNan, kNan, kNan, 0};
        const double mean = integral / volume;
        const double variance = std::max(0.0, squares / volume - mean * mean);
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

/// Sums of a pair of channels over samples present in both, by volume; `samples`: their number.
struct PairSums {
    double samples = 0, n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

    /// Adds a stretch. For complete columns only the products are computed; the rest is taken from their moments.
    void add(const Column& a, const Column& b, const Moments& ofA, const Moments& ofB, const Stretch& stretch) {
        if (a.whole && b.whole) {
            samples += ofA.samples;
            n += ofA.n;
            x += ofA.sum;
            y += ofB.sum;
            xx += ofA.squares;
            yy += ofB.squares;
            xy += laneSums<1>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
                lanes[0][lane] += stretch.weight[i] * (double(a.centred[i]) * double(b.centred[i]));
            })[0];
            return;
        }
        const auto sums = laneSums<7>(stretch, [&](std::size_t i, auto& lanes, std::size_t lane) {
            const double w = stretch.weight[i];
            const double u = double(a.centred[i]), v = double(b.centred[i]);
            const double p = double(a.present[i]) * w, q = double(b.present[i]) * w;
            lanes[0][lane] += double(a.present[i]) * q;
            lanes[1][lane] += u * q;
            lanes[2][lane] += v * p;
            lanes[3][lane] += u * u * q;
            lanes[4][lane] += v * v * p;
            lanes[5][lane] += u * v * w;
            lanes[6][lane] += double(a.present[i]) * double(b.present[i]) * stretch.shareOf(i);
        });
        add({sums[6], sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]});
    }
    void add(const PairSums& other) {
        samples += other.samples;
        n += other.n;
        x += other.x;
        y += other.y;
        xx += other.xx;
        yy += other.yy;
        xy += other.xy;
    }
    PairSums without(const PairSums& part) const {
        return {samples - part.samples, n - part.n, x - part.x, y - part.y, xx - part.xx, yy - part.yy, xy - part.xy};
    }
    double correlation() const {
        const double a = n * xx - x * x, b = n * yy - y * y;
        // What rounding leaves of a constant channel is no variance.
        constexpr double kEpsilon = 1e-12;
        if (samples < 2 || a <= kEpsilon * n * xx || b <= kEpsilon * n * yy) return kNan;
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
    /// Of a channel in units of its range / 65535, times volume in units of the box / 2^kThirdBits; or empty.
    std::vector<std::uint64_t> third, thirdVolume;
    std::vector<std::uint64_t> volume, focusVolume; ///< in units of the box / 2^kVolumeBits; or empty
    explicit Bins(std::size_t size = 0, bool withThird = false, bool byVolume = false)
        : packed(size), count(size), focus(size), third(withThird ? size : 0), thirdVolume(third.size()),
          volume(byVolume ? size : 0), focusVolume(volume.size()) {}

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
            thirdVolume[i] += flushed.thirdVolume[i];
        }
        for (std::size_t i = 0; i < volume.size(); ++i) {
            volume[i] += flushed.volume[i];
            focusVolume[i] += flushed.focusVolume[i];
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
