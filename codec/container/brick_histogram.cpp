#include "codec/container/brick_histogram.h"

#include "volume/base/number_extent.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <numeric>

namespace tessera::codec {

namespace {

constexpr int kMostBins = 32;
constexpr std::size_t kTurns =
    4; ///< partial histograms, used in turn so that increments of the same bin do not wait for each other

/// Removes absent and non-finite numbers; returns the input itself if there are none, else `kept`.
template <class T>
std::span<const T> counting(std::span<const T> all, std::span<const std::uint8_t> present, std::vector<T>& kept) {
    const auto counts = [&](std::size_t i) {
        bool is = volume::isPresent(present, i);
        if constexpr (std::same_as<T, float>) is = is && std::isfinite(all[i]);
        return is;
    };
    std::size_t first = 0;
    if (present.empty() && !std::same_as<T, float>) return all;
    while (first < all.size() && counts(first)) ++first;
    if (first == all.size()) return all;
    kept.assign(all.begin(), all.begin() + std::ptrdiff_t(first));
    for (std::size_t i = first; i < all.size(); ++i)
        if (counts(i)) kept.push_back(all[i]);
    return kept;
}

/// Scale and offset of stored numbers.
struct Meaning {
    double offset, scale;

    /// The decoded physical value.
    double valueOf(double number) const { return double(static_cast<float>(offset + scale * number)); }
    /// Whether every number of a type equals its value.
    template <class T> bool isPlain() const { return offset == 0 && scale == 1 && !std::same_as<T, std::int32_t>; }
};

/// Sum of the values of numbers; exact for small integers.
template <class T> double sumOf(std::span<const T> numbers, const Meaning& meaning) {
    const auto inLanes = [&](const auto& valueOf) {
        constexpr std::size_t kLanes = 8;
        std::array<double, kLanes> lanes{};
        std::size_t i = 0;
        for (; i + kLanes <= numbers.size(); i += kLanes)
            for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] += valueOf(numbers[i + lane]);
        for (; i < numbers.size(); ++i) lanes[0] += valueOf(numbers[i]);
        return std::accumulate(lanes.begin(), lanes.end(), 0.0);
    };
    if (!meaning.isPlain<T>()) return inLanes([&](T number) { return meaning.valueOf(double(number)); });
    if constexpr (std::same_as<T, float>) return inLanes([](T number) { return double(number); });
    std::int64_t sum = 0;
    for (const T number : numbers) sum += static_cast<std::int64_t>(number);
    return static_cast<double>(sum);
}

/// Maps stored numbers to bins.
struct Binning {
    Meaning meaning;
    double min, extent;
    int bins;

    std::uint8_t of(double number) const {
        const double place = (meaning.valueOf(number) - min) * bins / extent;
        return static_cast<std::uint8_t>(static_cast<int>(std::min(std::max(place, 0.0), double(bins - 1))));
    }
};

using HistogramCounts = std::array<std::uint32_t, kMostBins>;

template <class T>
HistogramCounts histogramOf(std::span<const T> numbers, const volume::NumberExtent<T>& extent, const Binning& binning) {
    std::array<HistogramCounts, kTurns> turns{};
    std::vector<std::uint8_t> binOf; // lookup table by number, if there are fewer numbers than samples
    if constexpr (!std::same_as<T, float>) {
        const std::int64_t least = extent.least, values = std::int64_t(extent.most) - least + 1;
        if (values <= std::int64_t(numbers.size() / 2)) {
            for (std::int64_t v = 0; v < values; ++v) binOf.push_back(binning.of(double(v + least)));
            const std::uint8_t* const bins = binOf.data();
            const auto first = static_cast<std::int32_t>(extent.least);
            std::size_t i = 0;
            for (; i + kTurns <= numbers.size(); i += kTurns)
                for (std::size_t k = 0; k < kTurns; ++k)
                    ++turns[k][bins[static_cast<std::uint32_t>(numbers[i + k]) - static_cast<std::uint32_t>(first)]];
            for (; i < numbers.size(); ++i)
                ++turns[0][bins[static_cast<std::uint32_t>(numbers[i]) - static_cast<std::uint32_t>(first)]];
        }
    }
    if (binOf.empty()) {
        constexpr std::size_t kRun = 1024;
        std::array<std::uint8_t, kRun> run;
        for (std::size_t first = 0; first < numbers.size(); first += kRun) {
            const std::size_t n = std::min(kRun, numbers.size() - first);
            for (std::size_t i = 0; i < n; ++i) run[i] = binning.of(double(numbers[first + i]));
            for (std::size_t i = 0; i < n; ++i) ++turns[i % kTurns][run[i]];
        }
    }
    HistogramCounts counts{};
    for (const HistogramCounts& turn : turns)
        for (std::size_t b = 0; b < counts.size(); ++b) counts[b] += turn[b];
    return counts;
}

/// Histogram of 8-bit numbers.
std::array<std::uint32_t, 256> occurrences(std::span<const std::uint8_t> numbers) {
    constexpr std::size_t kTables = 8; // used in turn: an increment of the same entry would wait for the previous one
    std::array<std::array<std::uint32_t, 256>, kTables> turns{};
    std::size_t i = 0;
    for (; i + kTables <= numbers.size(); i += kTables) {
        std::uint64_t eight;
        std::memcpy(&eight, numbers.data() + i, kTables);
        for (std::size_t k = 0; k < kTables; ++k) ++turns[k][eight >> (8 * k) & 255];
    }
    for (; i < numbers.size(); ++i) ++turns[0][numbers[i]];
    std::array<std::uint32_t, 256> sum{};
    for (const auto& turn : turns)
        for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += turn[v];
    return sum;
}

/// Writes the number of samples in the low half of the bins, in the width of the total, then recursively each half.
void putHalves(BitWriter& out, std::span<const std::uint32_t> counts, std::uint32_t all) {
    if (counts.size() < 2 || all == 0) return;
    const auto low = counts.first(counts.size() / 2), high = counts.subspan(counts.size() / 2);
    const std::uint32_t inLow = std::accumulate(low.begin(), low.end(), 0u);
    out.put(inLow, std::bit_width(all));
    putHalves(out, low, inLow);
    putHalves(out, high, all - inLow);
}

bool takeHalves(BitReader& in, std::span<std::uint32_t> counts, std::uint32_t all) {
    if (all == 0) return true;
    if (counts.size() == 1) {
        counts[0] = all;
        return true;
    }
    const std::uint32_t inLow = in.get(std::bit_width(all));
    if (in.failed || inLow > all) return false;
    const std::size_t half = counts.size() / 2;
    return takeHalves(in, counts.first(half), inLow) && takeHalves(in, counts.subspan(half), all - inLow);
}

} // namespace

int binsOf(std::uint32_t samples) {
    return 1 << std::clamp(int(std::bit_width(samples)) / 2 - 4, 0, 5);
}

bool hasSpread(float min, float max) {
    return min < max && std::isfinite(min) && std::isfinite(max);
}

BrickSummary summaryOf(volume::ScalarType type, double offset, double scale, std::span<const std::byte> samples,
                       std::span<const std::uint8_t> present, bool withHistogram) {
    return volume::dispatch(type, [&]<class T>(T) {
        BrickSummary brick;
        const std::span all(reinterpret_cast<const T*>(samples.data()), samples.size() / sizeof(T));
        std::vector<T> kept;
        const std::span<const T> numbers = counting(all, present, kept);
        BrickHistogram& histogram = brick.histogram;
        histogram.samples = static_cast<std::uint32_t>(numbers.size());
        if constexpr (std::same_as<T, float>) {
            const auto there = static_cast<std::uint32_t>(
                present.empty() ? all.size() : all.size() - std::size_t(std::count(present.begin(), present.end(), 0)));
            histogram.infinite = there - histogram.samples;
        }
        if (numbers.empty()) return brick;

        std::array<std::uint32_t, 256> times{}; // for bytes, everything follows from the histogram of numbers
        constexpr bool kBytes = std::same_as<T, std::uint8_t>;
        volume::NumberExtent<T> extent;
        if constexpr (kBytes) {
            if (withHistogram) {
                times = occurrences(numbers);
                while (times[extent.least] == 0) ++extent.least;
                extent.most = 255;
                while (times[extent.most] == 0) --extent.most;
            }
        }
        if (!kBytes || !withHistogram) extent = volume::extentOfNumbers(numbers);
        const Meaning meaning{offset, scale};
        const double a = meaning.valueOf(double(extent.least)), b = meaning.valueOf(double(extent.most));
        brick.min = static_cast<float>(std::min(a, b));
        brick.max = static_cast<float>(std::max(a, b));
        if (!withHistogram || !hasSpread(brick.min, brick.max)) return brick;

        const double from = double(brick.min), width = double(brick.max) - from;
        double sum = 0;
        if constexpr (kBytes)
            for (std::size_t v = 0; v < times.size(); ++v) sum += meaning.valueOf(double(v)) * times[v];
        else
            sum = sumOf(numbers, meaning);
        const double mean = sum / double(numbers.size());
        const double part = std::clamp((mean - from) / width, 0.0, 1.0);
        histogram.mean = static_cast<std::uint32_t>(std::lround(part * kMeanParts));
        const Binning binning{meaning, from, width, binsOf(histogram.samples)};
        if (binning.bins == 1) return brick;
        HistogramCounts counts{};
        if constexpr (kBytes)
            for (std::size_t v = extent.least; v <= extent.most; ++v) counts[binning.of(double(v))] += times[v];
        else
            counts = histogramOf(numbers, extent, binning);
        histogram.counts.assign(counts.begin(), counts.begin() + binning.bins);
        return brick;
    });
}

bool agree(const BrickSummary& brick, float min, float max, const BrickHistogram& noted) {
    constexpr std::int64_t kRounding = 2; // tolerance for sums added in another order
    if (!(brick.min <= brick.max)) return !(min <= max);
    return brick.min == min && brick.max == max && brick.histogram.samples == noted.samples &&
           brick.histogram.infinite == noted.infinite && brick.histogram.counts == noted.counts &&
           std::abs(std::int64_t(brick.histogram.mean) - std::int64_t(noted.mean)) <= kRounding;
}

void put(BitWriter& out, float min, float max, bool isFloat, const BrickHistogram& histogram) {
    if (!(min <= max)) return;
    if (isFloat) {
        out.put(histogram.infinite > 0 ? 1 : 0, 1);
        if (histogram.infinite > 0) out.put(histogram.infinite, std::bit_width(histogram.infinite + histogram.samples));
    }
    if (!hasSpread(min, max)) return;
    out.put(histogram.mean, 24);
    putHalves(out, histogram.counts, histogram.samples);
}

bool take(BitReader& in, float min, float max, bool isFloat, std::uint32_t present, BrickHistogram& histogram) {
    histogram = {};
    if (!(min <= max)) return true;
    if (isFloat && in.get(1) != 0) {
        histogram.infinite = in.get(std::bit_width(present));
        if (histogram.infinite == 0) return false;
    }
    if (in.failed || histogram.infinite >= present) return false;
    histogram.samples = present - histogram.infinite;
    if (!hasSpread(min, max)) return true;
    histogram.mean = in.get(24);
    const int bins = binsOf(histogram.samples);
    if (bins > 1) histogram.counts.resize(std::size_t(bins));
    return !in.failed && (bins == 1 || takeHalves(in, histogram.counts, histogram.samples));
}

std::optional<volume::BrickDistribution> distributionOf(float min, float max, double step,
                                                        const BrickHistogram& histogram) {
    volume::BrickDistribution out;
    if (!(min <= max)) return out;
    if (!std::isfinite(min) || !std::isfinite(max)) return std::nullopt;
    out.range = {double(min), double(max)};
    out.samples = histogram.samples;
    out.mean = out.range.lo + (out.range.hi - out.range.lo) * histogram.mean / kMeanParts;
    out.step = step;
    out.counts = histogram.counts;
    if (out.counts.empty()) out.counts = {histogram.samples};
    return out;
}

} // namespace tessera::codec
