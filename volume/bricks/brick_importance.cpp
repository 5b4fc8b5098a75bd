#include "volume/bricks/brick_importance.h"

#include "volume/base/number_extent.h"
#include "volume/base/parallel.h"
#include "volume/bricks/smoothed_half.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <map>

namespace tessera::volume {

namespace {

constexpr int kTones = 256;

TESSERA_INLINE std::uint32_t toneOf(float value01) {
    const auto tone = static_cast<std::int32_t>(value01 * kTones);
    return static_cast<std::uint32_t>(tone < kTones - 1 ? tone : kTones - 1);
}

/// Sums over the samples of one brick.
struct Sums {
    using Counts = std::array<std::uint32_t, kTones>;
    static constexpr int kTurns = 4; ///< sums and counts used in turn: the additions do not wait for each other

    double weight = 0, value = 0, square = 0, details = 0, axes = 0;
    int samples = 0;
    std::array<Counts, kTurns> tones{}; ///< of samples of weight 1
    Counts borderTones{};               ///< of those of the faces
    double borderWeight;

    explicit Sums(double ofBorder) : borderWeight(ofBorder) {}
    TESSERA_INLINE void add(float sample01, bool border) {
        const double value01 = double(sample01), w = border ? borderWeight : 1;
        weight += w;
        value += w * value01;
        square += w * value01 * value01;
        ++(border ? borderTones : tones[0])[toneOf(sample01)];
        ++samples;
    }
    /// The same for `count` values of the same kind.
    TESSERA_INLINE void add(const float* values, int count, bool border) {
        std::array<double, kTurns> first{}, second{};
        int x = 0;
        for (; x + kTurns <= count; x += kTurns)
            for (int i = 0; i < kTurns; ++i) {
                const double value01 = double(values[x + i]);
                first[std::size_t(i)] += value01;
                second[std::size_t(i)] += value01 * value01;
            }
        for (; x < count; ++x) {
            first[0] += double(values[x]);
            second[0] += double(values[x]) * double(values[x]);
        }
        const double w = border ? borderWeight : 1;
        weight += w * count;
        value += w * ((first[0] + first[1]) + (first[2] + first[3]));
        square += w * ((second[0] + second[1]) + (second[2] + second[3]));
        samples += count;
        constexpr int kRun = 64;
        std::array<std::uint32_t, kRun> run;
        for (int begin = 0; begin < count; begin += kRun) {
            const int n = count - begin < kRun ? count - begin : kRun;
            for (int i = 0; i < n; ++i) run[std::size_t(i)] = toneOf(values[begin + i]);
            int i = 0;
            for (; !border && i + kTurns <= n; i += kTurns)
                for (int turn = 0; turn < kTurns; ++turn) ++tones[std::size_t(turn)][run[std::size_t(i + turn)]];
            for (; i < n; ++i) ++(border ? borderTones : tones[0])[run[std::size_t(i)]];
        }
    }
    double entropy() const {
        double bits = 0;
        for (std::size_t i = 0; i < kTones; ++i) {
            const double tone =
                double(tones[0][i] + tones[1][i] + tones[2][i] + tones[3][i]) + borderWeight * double(borderTones[i]);
            if (tone > 0) bits -= tone / weight * std::log2(tone / weight);
        }
        return samples > 1 ? std::min(bits / std::log2(double(std::min(samples, kTones))), 1.0) : 0.0;
    }
    BrickImportance result() const {
        if (weight == 0) return {};
        // Smaller numbers are rounding errors of floats.
        constexpr double kLeastVariance = 1e-12, kLeastDetail = 1e-6;
        const double mean = value / weight, variance = square / weight - mean * mean;
        const double detail = axes > 0 ? std::sqrt(details / axes) : 0.0;
        return {variance < kLeastVariance ? 0.0f : float(std::cbrt(std::min(mean * 4 * variance * entropy(), 1.0))),
                detail < kLeastDetail ? 0.0f : float(std::min(detail, 1.0))};
    }
};

/// Sum of squared differences of `count` samples from the mean of the samples a step before and after.
TESSERA_INLINE double squaresOfDetails(const float* row, std::ptrdiff_t step, int count) {
    constexpr int kTurns = 8; // as one sum would wait for the one before
    std::array<float, kTurns> sums{};
    int x = 0;
    for (; x + kTurns <= count; x += kTurns)
        for (int i = 0; i < kTurns; ++i) {
            const float detail = row[x + i] - 0.5f * (row[x + i - step] + row[x + i + step]);
            sums[std::size_t(i)] += detail * detail;
        }
    double sum = 0;
    for (; x < count; ++x) {
        const float detail = row[x] - 0.5f * (row[x - step] + row[x + step]);
        sum += double(detail * detail);
    }
    for (const float part : sums) sum += double(part);
    return sum;
}

/// Adds a row of a brick without absent samples; `border`: all of it lies on a face.
TESSERA_INLINE void addRow(const Smoothed& from, int begin, int end, int y, int z, bool border, Sums& sums) {
    const auto step = std::ptrdiff_t(from.size.x), slice = step * from.size.y;
    const float* row = from.values.data() + from.index({begin, y, z});
    if (z + 2 < from.size.z) { // the next slices are far away
        __builtin_prefetch(row + 2 * slice);
        __builtin_prefetch(row + 2 * slice + 16);
    }
    const int count = end - begin, first = begin == 0 ? 1 : 0, last = end == from.size.x ? count - 1 : count;
    if (last > first) sums.details += squaresOfDetails(row + first, 1, last - first), sums.axes += last - first;
    if (y > 0 && y + 1 < from.size.y) sums.details += squaresOfDetails(row, step, count), sums.axes += count;
    if (z > 0 && z + 1 < from.size.z) sums.details += squaresOfDetails(row, slice, count), sums.axes += count;
    if (border || count < 2) {
        sums.add(row, count, true);
        return;
    }
    sums.add(row[0], true);
    sums.add(row + 1, count - 2, false);
    sums.add(row[count - 1], true);
}

/// Adds all rows of a brick without absent samples.
TESSERA_INLINE void addRowsOf(const Smoothed& from, glm::ivec3 begin, glm::ivec3 end, Sums& sums) {
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y) {
            const bool border = y == begin.y || y == end.y - 1 || z == begin.z || z == end.z - 1;
            addRow(from, begin.x, end.x, y, z, border, sums);
        }
}
void addRows(const Smoothed& from, glm::ivec3 begin, glm::ivec3 end, Sums& sums) {
    addRowsOf(from, begin, end, sums);
}
TESSERA_AVX2 void addRowsAvx2(const Smoothed& from, glm::ivec3 begin, glm::ivec3 end, Sums& sums) {
    addRowsOf(from, begin, end, sums);
}

/// Adds the samples of a sublattice in the brick that covers [begin, end) of the halved one.
void addBrick(const Smoothed& from, glm::ivec3 begin, glm::ivec3 end, Cpu cpu, Sums& sums) {
    if (from.coverage.empty()) {
        (cpu == Cpu::Portable ? addRows : addRowsAvx2)(from, begin, end, sums);
        return;
    }
    const std::size_t steps[] = {1, std::size_t(from.size.x), std::size_t(from.size.x) * std::size_t(from.size.y)};
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) {
                const glm::ivec3 at(x, y, z);
                const std::size_t i = from.index(at);
                if (!from.has(i)) continue;
                bool border = false;
                for (int axis = 0; axis < 3; ++axis) {
                    border = border || at[axis] == begin[axis] || at[axis] == end[axis] - 1;
                    if (at[axis] == 0 || at[axis] + 1 == from.size[axis]) continue;
                    const std::size_t left = i - steps[axis], right = i + steps[axis];
                    if (!from.has(left) || !from.has(right)) continue;
                    const double detail =
                        double(from.values[i]) - 0.5 * (double(from.values[left]) + double(from.values[right]));
                    sums.details += detail * detail;
                    ++sums.axes;
                }
                sums.add(from.values[i], border);
            }
}

/// For labels: the entropy of their values.
BrickImportance importanceOfLabels(const BrickGrid& grid, const Field& field, glm::ivec3 brick) {
    const glm::ivec3 begin = grid.begin(brick), end = grid.end(brick);
    std::map<double, std::size_t> counts;
    std::size_t samples = 0;
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) {
                const std::size_t i = field.lattice.index({x, y, z});
                if (!field.present(i)) continue;
                const double label = field.value(i);
                if (!std::isfinite(label)) continue;
                ++counts[label];
                ++samples;
            }
    if (counts.size() < 2) return {};
    double bits = 0;
    for (const auto& [label, count] : counts) {
        const double part = double(count) / double(samples);
        bits -= part * std::log2(part);
    }
    const auto entropy = float(bits / std::log2(double(std::min<std::size_t>(samples, kTones))));
    return {std::min(entropy, 1.0f), std::min(entropy, 1.0f)};
}

/// Range of the present, finite samples, and whether all samples are such.
struct Extent {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    bool gaps = false;

    void add(const Extent& part) {
        range = {std::min(range.lo, part.range.lo), std::max(range.hi, part.range.hi)};
        gaps = gaps || part.gaps;
    }
    SmoothedRange within(Range whole) const { return {whole, gaps, whole.lo <= range.lo && range.hi <= whole.hi}; }
};

Extent extentOf(const Field& field) {
    Extent extent;
    dispatch(field.type, [&]<class T>(T) {
        const auto samples = field.as<T>();
        T lo{}, hi{};
        bool any = false;
        if constexpr (!std::same_as<T, float>)
            if (!field.mask && !samples.empty()) {
                const NumberExtent<T> all = extentOfNumbers(std::span<const T>(samples));
                lo = all.least, hi = all.most, any = true;
            }
        const std::size_t seen = any ? samples.size() : 0;
        for (std::size_t i = seen; i < samples.size(); ++i) {
            bool there = field.present(i);
            if constexpr (std::same_as<T, float>) there = there && std::isfinite(samples[i]);
            if (!there) {
                extent.gaps = true;
                continue;
            }
            if (!any) lo = hi = samples[i];
            any = true;
            lo = std::min(lo, samples[i]);
            hi = std::max(hi, samples[i]);
        }
        const double a = field.offset + field.scale * double(lo), b = field.offset + field.scale * double(hi);
        if (any) extent.range = {std::min(a, b), std::max(a, b)};
    });
    return extent;
}

glm::ivec3 brickAt(glm::ivec3 count, std::size_t number) {
    const std::size_t nx = std::size_t(count.x), ny = std::size_t(count.y);
    return {int(number % nx), int(number / nx % ny), int(number / (nx * ny))};
}

/// Adds to each brick a share of the difference to its most important neighbour.
std::vector<BrickImportance> withNeighbours(const std::vector<BrickImportance>& own, glm::ivec3 count, double share) {
    std::vector<BrickImportance> out = own;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const glm::ivec3 brick = brickAt(count, i);
        BrickImportance most = own[i];
        const glm::ivec3 lo = glm::max(brick - 1, glm::ivec3(0)), hi = glm::min(brick + 2, count);
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y)
                for (int x = lo.x; x < hi.x; ++x) {
                    const BrickImportance& near = own[std::size_t((z * count.y + y) * count.x + x)];
                    most.importance = std::max(most.importance, near.importance);
                    most.detail = std::max(most.detail, near.detail);
                }
        out[i].importance += float(share) * (most.importance - own[i].importance);
        out[i].detail += float(share) * (most.detail - own[i].detail);
    }
    return out;
}

/// A part of a frame: its slices from texel `first` (an even one) on, which hold the layers [layer, end) of bricks.
struct LayersOfBricks {
    const Field& field;
    int first = 0, layer = 0, end = 0;
};

/// Importance of bricks without the share of their neighbours.
struct OwnImportance {
    const BrickGrid& grid;
    SmoothedRange about;
    double borderWeight;
    Cpu cpu;

    std::size_t perLayer() const { return std::size_t(grid.count().x) * std::size_t(grid.count().y); }
    int slices() const { return grid.lattice.kind == LatticeKind::BCC ? 2 : 1; } ///< of a texel

    /// Of the bricks of a part that has kMargin texels more than those on both sides, where there are so many.
    std::vector<BrickImportance> of(const LayersOfBricks& part) const {
        std::vector<Smoothed> halves;
        for (int s = 0; s < slices(); ++s) halves.push_back(smoothedHalf(part.field, s, about, cpu));
        const glm::ivec3 shift(0, 0, part.first / 2);
        return forBricks(part, [&](std::size_t i) {
            const glm::ivec3 brick = brickAt(grid.count(), perLayer() * std::size_t(part.layer) + i);
            Sums sums(borderWeight);
            for (const Smoothed& half : halves) {
                const glm::ivec3 lo = (brick * grid.brickSize + 1) / 2 - shift,
                                 hi = glm::min((brick * grid.brickSize + grid.brickSize + 1) / 2 - shift, half.size);
                addBrick(half, lo, hi, cpu, sums);
            }
            return sums.result();
        });
    }
    /// The same for labels, which need no margins.
    std::vector<BrickImportance> ofLabels(const LayersOfBricks& part) const {
        BrickGrid own = grid;
        own.lattice = part.field.lattice;
        return forBricks(part,
                         [&](std::size_t i) { return importanceOfLabels(own, part.field, brickAt(own.count(), i)); });
    }

    static constexpr int kMargin = 4; ///< reach of the details of smoothed samples

private:
    std::vector<BrickImportance> forBricks(const LayersOfBricks& part, const auto& of) const {
        std::vector<BrickImportance> bricks(perLayer() * std::size_t(part.end - part.layer));
        parallelFor(bricks.size(), [&](std::size_t i) { bricks[i] = of(i); });
        return bricks;
    }
};

/// Importance of all bricks of a frame. `ofParts.operator()<T>(margin, of)` gives what `of(part)` gives, a vector of T,
/// one after the other for parts that together hold all layers of bricks, with `margin` texels more on both sides.
std::vector<BrickImportance> importanceOfParts(const BrickGrid& grid, Range range, bool categorical,
                                               const ImportanceOptions& options, Cpu cpu, const auto& ofParts) {
    const glm::ivec3 count = grid.count();
    const auto own = [&](int margin, const std::function<std::vector<BrickImportance>(const LayersOfBricks&)>& of) {
        return withNeighbours(ofParts.template operator()<BrickImportance>(margin, of), count, options.neighbours);
    };
    if (categorical) {
        const OwnImportance labels{grid, {range}, 1, cpu};
        return own(0, [&](const LayersOfBricks& part) { return labels.ofLabels(part); });
    }
    Extent extent;
    const auto extentOfPart = [](const LayersOfBricks& part) { return std::vector<Extent>{extentOf(part.field)}; };
    for (const Extent& part : ofParts.template operator()<Extent>(0, extentOfPart)) extent.add(part);
    if (!(range.lo <= range.hi)) range = extent.range;
    if (!(range.lo < range.hi)) return std::vector<BrickImportance>(countOf(count)); // one value, or nothing
    const OwnImportance smooth{grid, extent.within(range), options.borderWeight, cpu};
    return own(OwnImportance::kMargin, [&](const LayersOfBricks& part) { return smooth.of(part); });
}

} // namespace

std::vector<BrickImportance> importanceOfBricks(const BrickGrid& grid, const Field& field, Range range,
                                                bool categorical, const ImportanceOptions& options, Cpu cpu) {
    return importanceOfParts(grid, range, categorical, options, cpu,
                             [&]<class T>(int, const std::function<std::vector<T>(const LayersOfBricks&)>& of) {
                                 return of({field, 0, 0, grid.count().z});
                             });
}

std::vector<BrickImportance> importanceOfBricks(const BrickGrid& grid,
                                                const std::function<void(int first, int count, Field& part)>& read,
                                                int layers, Range range, bool categorical,
                                                const ImportanceOptions& options, const Pieces& pieces) {
    const int all = grid.count().z, texels = grid.lattice.texels().z;
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1; // of a texel
    Field part;
    return importanceOfParts(
        grid, range, categorical, options, bestCpu(),
        [&]<class T>(int margin, const std::function<std::vector<T>(const LayersOfBricks&)>& of) {
            return valuesOf<T>(pieces, std::size_t((all + layers - 1) / layers), [&](std::size_t piece) {
                const int layer = int(piece) * layers, end = std::min(layer + layers, all);
                const int first = std::max(layer * grid.brickSize - margin, 0),
                          last = std::min(end * grid.brickSize + margin, texels);
                const int from = first * slices, to = std::min(last * slices, grid.lattice.size.z);
                read(from, to - from, part);
                return of({part, first, layer, end});
            });
        });
}

} // namespace tessera::volume
