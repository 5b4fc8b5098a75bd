#include "codec/wavelet/lifting.h"

#include "codec/wavelet/filter.h"
#include "codec/wavelet/lift_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

namespace tessera::codec {

namespace {

/// floor(x / 2^shift) of a 32-bit value modulo 2^32.
std::uint32_t shiftDown(std::uint32_t x, int shift) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x) >> shift);
}

std::int64_t wide(std::uint32_t x) {
    return static_cast<std::int32_t>(x);
}

/// The sum of a step that is not one of pairs (isOfPairs) at one sample, with the rules for absent taps. An update has
/// the antisymmetric pairs (row - 1 - j, row + 1 + j).
std::uint32_t tapSum(const LiftStep& step, const Rows& target, const Rows& source, int row, int lane) {
    if (!source.has(row, lane)) return 0;
    std::int64_t sum = step.centre * wide(source.at(row, lane));
    // Only details predicted from all their even neighbours.
    const auto usable = [&](int at) { return source.has(at, lane) && target.has(at, lane); };
    for (int j = 0; j < step.pairs; ++j) {
        const int left = row - 1 - j, right = row + 1 + j;
        if (!usable(left) || !usable(right)) break;
        sum += step.weight[std::size_t(j)] * (wide(source.at(right, lane)) - wide(source.at(left, lane)));
    }
    const std::int64_t half = step.shift > 0 ? std::int64_t(1) << (step.shift - 1) : 0;
    return static_cast<std::uint32_t>((sum + half) >> step.shift);
}

/// The mean of two floats; +0 where it is not finite, since arithmetic on NaN payloads differs between machines.
std::uint32_t floatMean(std::uint32_t a, std::uint32_t b) {
    const float mean = 0.5f * floatOfCode(a) + 0.5f * floatOfCode(b);
    return std::isfinite(mean) ? codeOfFloat(mean) : 0;
}

std::uint32_t floatPrediction(const LiftStep& step, const Rows& source, int row, int lane) {
    if (step.centre != 0) return source.has(row, lane) ? source.at(row, lane) : 0;
    const bool left = source.has(row, lane), right = source.has(row + 1, lane);
    if (!left && !right) return 0;
    return floatMean(source.at(left ? row : row + 1, lane), source.at(right ? row + 1 : row, lane));
}

/// target[i] += sign * prediction(i), where sign is 1 or 2^32 - 1.
void apply(const LiftStep& step, bool update, const Rows& target, const Rows& source, std::uint32_t sign,
           Arithmetic arithmetic, std::vector<std::uint8_t>& usable, Cpu cpu) {
    const int lanes = target.lanes;
    const bool masked = target.present != nullptr;
    if (arithmetic != Arithmetic::Float && isOfPairs(step))
        return applyPairs(step, update, target, source, sign, arithmetic == Arithmetic::Wide, usable, cpu);
    int begin = 0; // rows already handled by the fast loops below
    if (!masked && arithmetic != Arithmetic::Float && step.pairs == 0) {
        begin = std::min(target.rows, source.rows);
        const std::size_t count = std::size_t(begin) * std::size_t(lanes);
        std::uint32_t* const t = target.values;
        const std::uint32_t* const s = source.values;
        if (step.shift == 0)
            for (std::size_t i = 0; i < count; ++i) t[i] += sign * s[i];
        else // (d + 1) >> 1 without overflow
            for (std::size_t i = 0; i < count; ++i) t[i] += sign * (shiftDown(s[i], 1) + (s[i] & 1u));
    }
    for (int row = begin; row < target.rows; ++row) {
        std::uint32_t* t = target.values + std::ptrdiff_t(row) * lanes;
        for (int lane = 0; lane < lanes; ++lane) {
            if (masked && !target.has(row, lane)) continue;
            t[lane] += sign * (arithmetic == Arithmetic::Float ? floatPrediction(step, source, row, lane)
                                                               : tapSum(step, target, source, row, lane));
        }
    }
}

/// Position of row i of a line when even rows come before odd ones.
int splitRow(int i, int count) {
    return i % 2 == 0 ? i / 2 : (count + 1) / 2 + i / 2;
}

/// `lanes` lines of `count` samples, `pitch` elements apart; the lines are `lanePitch` elements apart.
struct Lines {
    std::uint32_t* values;
    std::uint8_t* present; ///< null: all present
    int count;
    std::ptrdiff_t pitch;
    int lanes;
    std::ptrdiff_t lanePitch;
};

/// Copies lines to `scratch` or back; `splitting`: the copy has even rows before odd ones.
template <bool toScratch, class T> void copyRows(T* lines, const Lines& shape, T* scratch, bool splitting) {
    for (int i = 0; i < shape.count; ++i) {
        T* there = scratch + std::ptrdiff_t(splitting ? splitRow(i, shape.count) : i) * shape.lanes;
        T* here = lines + i * shape.pitch;
        if (shape.lanePitch == 1)
            std::memcpy(toScratch ? there : here, toScratch ? here : there, sizeof(T) * std::size_t(shape.lanes));
        else
            for (int lane = 0; lane < shape.lanes; ++lane, here += shape.lanePitch)
                (toScratch ? there[lane] : *here) = toScratch ? *here : there[lane];
    }
}

struct Scratch {
    Cpu cpu;
    std::vector<std::uint32_t> values{};
    std::vector<std::uint8_t> present{}, usable{};
};

void liftLines(const Lines& lines, const LiftFilter& filter, Arithmetic arithmetic, bool isForward, Scratch& scratch) {
    if (lines.count < 2 || lines.lanes < 1) return;
    const int evens = (lines.count + 1) / 2, odds = lines.count / 2;
    const std::ptrdiff_t oddStart = std::ptrdiff_t(evens) * lines.lanes;
    const std::size_t all = std::size_t(lines.count) * std::size_t(lines.lanes);
    if (scratch.values.size() < all) scratch.values.resize(all);
    std::uint32_t* values = scratch.values.data();
    std::uint8_t* present = nullptr;
    if (lines.present) {
        if (scratch.present.size() < all) scratch.present.resize(all);
        present = scratch.present.data();
        copyRows<true>(lines.present, lines, present, isForward);
    }
    copyRows<true>(lines.values, lines, values, isForward);
    const Rows even{values, present, evens, lines.lanes};
    const Rows odd{values + oddStart, present ? present + oddStart : nullptr, odds, lines.lanes};
    const auto predict = [&](std::uint32_t sign) {
        apply(filter.predict, false, odd, even, sign, arithmetic, scratch.usable, scratch.cpu);
    };
    const auto change = [&](std::uint32_t sign) {
        if (filter.updates) apply(filter.update, true, even, odd, sign, arithmetic, scratch.usable, scratch.cpu);
    };
    constexpr std::uint32_t plus = 1, minus = ~0u;
    isForward ? predict(minus) : change(minus);
    isForward ? change(plus) : predict(plus);
    copyRows<false>(lines.values, lines, values, !isForward);
    if (present) copyRows<false>(lines.present, lines, present, !isForward);
}

/// The samples of a block and its line layout: `full` is the size of the arrays, `part` the corner being transformed.
struct Block {
    std::uint32_t* values;
    std::uint8_t* present;
    glm::ivec3 full;
};

void liftAxis(const Block& block, glm::ivec3 part, int axis, const LiftFilter& filter, Arithmetic arithmetic,
              bool isForward, Scratch& scratch) {
    if (part.x < 1 || part.y < 1 || part.z < 1) return; // the odd sublattice of a single slice
    const std::ptrdiff_t row = block.full.x, slice = row * block.full.y;
    const glm::ivec3 low = levelSize(part, 1);
    const auto lift = [&](std::ptrdiff_t at, int count, std::ptrdiff_t pitch, int lanes, bool samples,
                          std::ptrdiff_t lanePitch = 1) {
        const Lines lines{block.values + at, block.present ? block.present + at : nullptr, count, pitch, lanes,
                          lanePitch};
        const bool details = arithmetic == Arithmetic::Float && !samples;
        liftLines(lines, filter, details ? Arithmetic::Wide : arithmetic, isForward, scratch);
    };
    // Under Float arithmetic, the details of an earlier axis are predicted as integers.
    const bool cut = arithmetic == Arithmetic::Float;
    if (axis == 0) {
        for (int z = 0; z < part.z; ++z) lift(z * slice, part.x, 1, part.y, true, row);
    } else if (axis == 1) {
        for (int z = 0; z < part.z; ++z) {
            lift(z * slice, part.y, row, cut ? low.x : part.x, true);
            if (cut) lift(z * slice + low.x, part.y, row, part.x - low.x, false);
        }
    } else {
        for (int y = 0; y < part.y; ++y) {
            const bool samples = !cut || y < low.y;
            const int lanes = cut && samples ? low.x : part.x;
            lift(y * row, part.z, slice, lanes, samples);
            if (lanes < part.x) lift(y * row + lanes, part.z, slice, part.x - lanes, false);
        }
    }
}

} // namespace

double levelPhase(Wavelet wavelet) {
    return wavelet == Wavelet::W11 || wavelet == Wavelet::W13 || wavelet == Wavelet::W15 ? 0.5 : 0.0;
}

glm::ivec3 levelSize(glm::ivec3 size, int level) {
    const int up = (1 << level) - 1;
    return {(size.x + up) >> level, (size.y + up) >> level, (size.z + up) >> level};
}

void forward(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic, Cpu cpu) {
    const LiftFilter filter = filterOf(wavelet);
    assert(arithmetic != Arithmetic::Float || !filter.updates);
    const Block block{values.data(), present.empty() ? nullptr : present.data(), size};
    Scratch scratch{cpu};
    for (int step = 0; step < steps; ++step)
        for (int axis = 0; axis < 3; ++axis)
            liftAxis(block, levelSize(size, step), axis, filter, arithmetic, true, scratch);
}

void inverse(std::span<std::uint32_t> values, std::span<std::uint8_t> present, glm::ivec3 size, int steps,
             Wavelet wavelet, Arithmetic arithmetic, Cpu cpu) {
    const LiftFilter filter = filterOf(wavelet);
    assert(arithmetic != Arithmetic::Float || !filter.updates);
    const Block block{values.data(), present.empty() ? nullptr : present.data(), size};
    Scratch scratch{cpu};
    for (int step = steps - 1; step >= 0; --step)
        for (int axis = 2; axis >= 0; --axis)
            liftAxis(block, levelSize(size, step), axis, filter, arithmetic, false, scratch);
}

void liftAlong(int axis, bool isForward, std::uint32_t* values, std::uint8_t* present, glm::ivec3 size,
               std::ptrdiff_t row, std::ptrdiff_t slice, Wavelet wavelet, Arithmetic arithmetic, Cpu cpu) {
    assert(arithmetic != Arithmetic::Float);
    const LiftFilter filter = filterOf(wavelet);
    Scratch scratch{cpu};
    const bool alongZ = axis == 2;
    for (int i = 0; i < (alongZ ? size.y : size.z); ++i) {
        const std::ptrdiff_t at = i * (alongZ ? row : slice);
        const Lines lines =
            axis == 0
                ? Lines{values + at, present ? present + at : nullptr, size.x, 1, size.y, row}
                : Lines{values + at, present ? present + at : nullptr, size[axis], alongZ ? slice : row, size.x, 1};
        liftLines(lines, filter, arithmetic, isForward, scratch);
    }
}

void deinterleave(std::span<std::uint8_t> present, glm::ivec3 size, int steps) {
    std::vector<std::uint8_t> from;
    for (int step = 0; step < steps; ++step) {
        const glm::ivec3 part = levelSize(size, step);
        from.assign(present.begin(), present.end());
        std::size_t rowStart = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y, rowStart += std::size_t(size.x)) {
                if (z >= part.z || y >= part.y) continue;
                const std::size_t to =
                    (std::size_t(splitRow(z, part.z)) * std::size_t(size.y) + std::size_t(splitRow(y, part.y))) *
                    std::size_t(size.x);
                for (int x = 0; x < part.x; ++x)
                    present[to + std::size_t(splitRow(x, part.x))] = from[rowStart + std::size_t(x)];
            }
    }
}

std::uint32_t codeOfFloat(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return (bits & 0x80000000u) != 0 ? ~bits ^ 0x80000000u : bits;
}

float floatOfCode(std::uint32_t code) {
    return std::bit_cast<float>((code & 0x80000000u) != 0 ? ~(code ^ 0x80000000u) : code);
}

} // namespace tessera::codec
