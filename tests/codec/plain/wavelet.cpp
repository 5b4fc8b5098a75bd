#include "tests/codec/plain/wavelet.h"

#include <cmath>

namespace tessera::codec::plain {

namespace {

/// 4.3: P and U of one wavelet.
struct Taps {
    int center = 0;
    std::vector<int> weights;
    int shift = 0;
    bool antisymmetric = false;
};

struct Line {
    std::vector<Cell> even, odd;
    static Cell at(const std::vector<Cell>& cells, int i) {
        return i < 0 || i >= int(cells.size()) ? Cell() : cells[std::size_t(i)];
    }
    Cell e(int i) const { return at(even, i); }
    Cell d(int i) const { return at(odd, i); }
};

std::uint32_t finish(std::int64_t sum, int shift) {
    const std::int64_t divisor = std::int64_t(1) << shift;
    sum += shift > 0 ? divisor / 2 : 0;
    return std::uint32_t(sum >= 0 ? sum / divisor : -((-sum + divisor - 1) / divisor));
}

std::uint32_t predict(const Line& line, int i, int wavelet, bool asFloat) {
    const bool mean = wavelet == 1 || wavelet >= 5, cubic = wavelet >= 8;
    const Cell left = line.e(i);
    if (!mean) return left.value_or(0);
    const Cell right = line.e(i + 1);
    if (!left && !right) return 0;
    const std::uint32_t a = left ? *left : *right, b = right ? *right : *left;
    if (cubic) { // 9 and -1 sixteenths; the pair further out, or the inner one again
        const Cell farLeft = line.e(i - 1), farRight = line.e(i + 2);
        const bool whole = farLeft && farRight;
        const std::int64_t inner = asSigned(a) + asSigned(b);
        return finish(9 * inner - (whole ? asSigned(*farLeft) + asSigned(*farRight) : inner), 4);
    }
    if (!asFloat) return finish(asSigned(a) + asSigned(b), 1);
    const float half = 0.5f * floatOf(a), other = 0.5f * floatOf(b), sum = half + other;
    return std::isfinite(sum) ? codeOf(sum) : 0;
}

std::uint32_t update(const Line& line, int i, int wavelet) {
    static const Taps kTaps[] = {{1, {}, 1, false},
                                 {8, {-1}, 4, true},
                                 {128, {-22, 3}, 8, true},
                                 {0, {1}, 2, false},
                                 {0, {19, -3}, 6, false},
                                 {0, {162, -39, 5}, 9, false},
                                 {}, // 4,0
                                 {0, {1}, 2, false},
                                 {0, {9, -1}, 5, false},
                                 {0, {306, -59, 9}, 10, false}};
    const Taps& taps = kTaps[wavelet - 2];
    // A detail, if it was predicted from all its even samples.
    const auto detail = [&](int k) {
        const bool whole = line.e(k) && (taps.antisymmetric || line.e(k + 1));
        return whole ? line.d(k) : Cell();
    };
    std::int64_t sum = 0;
    if (taps.center != 0) {
        if (!line.d(i)) return 0;
        sum = taps.center * asSigned(*line.d(i));
    }
    std::int64_t pair = 0; // of the last whole pair
    bool broken = false;
    for (std::size_t j = 0; j < taps.weights.size(); ++j) {
        const int n = int(j);
        const Cell left = detail(i - 1 - n), right = detail(taps.antisymmetric ? i + 1 + n : i + n);
        if (taps.antisymmetric) {
            if (!left || !right) break;
            sum += taps.weights[j] * (asSigned(*right) - asSigned(*left));
            continue;
        }
        if (j == 0) {
            if (!left && !right) return 0;
            pair = asSigned(left ? *left : *right) + asSigned(right ? *right : *left);
        } else if (!broken && left && right) {
            pair = asSigned(*left) + asSigned(*right);
        } else {
            broken = true;
        }
        sum += taps.weights[j] * pair;
    }
    return finish(sum, taps.shift);
}

bool updates(int wavelet) {
    return wavelet >= 2 && wavelet != 8;
}
} // namespace

std::vector<Cell> redo(const std::vector<Cell>& cells, int wavelet, bool asFloat) {
    if (cells.size() == 1) return cells;
    Line line;
    for (std::size_t i = 0; i < cells.size(); ++i) (i % 2 == 0 ? line.even : line.odd).push_back(cells[i]);
    for (std::size_t i = 0; i < line.odd.size(); ++i)
        if (line.odd[i]) line.odd[i] = *line.odd[i] - predict(line, int(i), wavelet, asFloat);
    std::vector<Cell> updated = line.even;
    for (std::size_t i = 0; updates(wavelet) && i < updated.size(); ++i)
        if (updated[i]) updated[i] = *updated[i] + update(line, int(i), wavelet);
    updated.insert(updated.end(), line.odd.begin(), line.odd.end());
    return updated;
}

std::vector<Cell> undo(const std::vector<Cell>& cells, int wavelet, bool asFloat) {
    const std::size_t n = cells.size(), evens = (n + 1) / 2;
    if (n == 1) return cells;
    Line line{{cells.begin(), cells.begin() + std::ptrdiff_t(evens)},
              {cells.begin() + std::ptrdiff_t(evens), cells.end()}};
    if (updates(wavelet)) {
        std::vector<Cell> updated = line.even;
        for (std::size_t i = 0; i < evens; ++i)
            if (updated[i]) updated[i] = *updated[i] - update(line, int(i), wavelet);
        line.even = updated;
    }
    for (std::size_t i = 0; i < line.odd.size(); ++i)
        if (line.odd[i]) line.odd[i] = *line.odd[i] + predict(line, int(i), wavelet, asFloat);
    std::vector<Cell> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(i % 2 == 0 ? line.even[i / 2] : line.odd[i / 2]);
    return out;
}

Size half(const Size& size) {
    return {(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2};
}

Box makeBox(const Size& size) {
    return {size, std::vector<Cell>(std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]))};
}

void split(Box& flags, int steps) {
    Size part = flags.size;
    for (int step = 0; step < steps; ++step, part = half(part)) {
        Box from = flags;
        places({0, 0, 0}, part, [&](const Size& p) {
            Size to;
            for (std::size_t a = 0; a < 3; ++a) to[a] = p[a] % 2 == 0 ? p[a] / 2 : (part[a] + 1) / 2 + p[a] / 2;
            flags.at(to) = from.at(p);
        });
    }
}

void predictOdd(Box& even, Box& odd, int level) {
    const auto power = std::int64_t(2) << level;
    const std::int64_t far[] = {-1, 9, 9, -1}, near[] = {0, power - 1, 1, 0};
    const std::int64_t* const weights = level == 0 ? far : near;
    const std::int64_t one = level == 0 ? 16 : power, whole = one * one * one;
    // An even sample, beyond the ends as the level says.
    const auto sampleAt = [&](auto&& self, Size at, std::size_t axis) -> std::int64_t {
        if (axis == 3) return asSigned(*even.at(at));
        const int last = even.size[axis] - 1;
        if (at[axis] >= 0 && at[axis] <= last) return self(self, at, axis + 1);
        const bool goesOn = level > 0 && at[axis] > last && last > 0;
        at[axis] = at[axis] < 0 ? 0 : last;
        const std::int64_t end = self(self, at, axis + 1);
        if (!goesOn) return end;
        --at[axis];
        return 2 * end - self(self, at, axis + 1);
    };
    places({0, 0, 0}, odd.size, [&](const Size& p) {
        std::int64_t sum = whole / 2;
        places({0, 0, 0}, {4, 4, 4}, [&](const Size& tap) {
            const std::int64_t weight = weights[tap[0]] * weights[tap[1]] * weights[tap[2]];
            if (weight != 0)
                sum += weight * sampleAt(sampleAt, {p[0] - 1 + tap[0], p[1] - 1 + tap[1], p[2] - 1 + tap[2]}, 0);
        });
        const auto foreseen = std::uint32_t(sum >= 0 ? sum / whole : -((-sum + whole - 1) / whole));
        odd.at(p) = level == 0 ? *odd.at(p) + foreseen : foreseen;
    });
}

} // namespace tessera::codec::plain
