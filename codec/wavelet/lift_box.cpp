#include "codec/wavelet/lift_box.h"

#include "codec/wavelet/filter.h"
#include "codec/wavelet/lift_lines.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <type_traits>

namespace tessera::codec {

namespace {

template <class Word> struct Sources { std::array<const Word*, 3> left{}, right{}; };

/// The predictions as compile-time constants, so that multiplications become shifts.
constexpr LiftStep kSame{1, 0, {}, false, 0}, kMean{0, 1, {1}, false, 1}, kCubic{0, 2, {9, -1}, false, 4};

constexpr bool isUpdate(const LiftStep& step) {
    return step != kSame && step != kMean && step != kCubic;
}
/// Whether the sums of a step fit into 16-bit words for codes of kBitsOfInt16 bits.
constexpr bool sumsFitInt16(const LiftStep& step) {
    return step.pairs < 2 || isCubic(step);
}

/// floor((sum of w_j (left_j + right_j) + half) / 2^shift), modulo the type.
template <class Sum, LiftStep kStep> TESSERA_INLINE Sum changeOf(Sum l0, Sum r0, Sum l1, Sum r1, Sum l2, Sum r2) {
    using Modulo = std::make_unsigned_t<Sum>;
    const auto add = [](Sum a, Sum b) { return static_cast<Sum>(Modulo(Modulo(a) + Modulo(b))); };
    const auto times = [](int w, Sum a) { return static_cast<Sum>(Modulo(Modulo(w) * Modulo(a))); };
    constexpr Sum kHalfStep = kStep.shift > 0 ? Sum(1 << (kStep.shift > 0 ? kStep.shift - 1 : 0)) : Sum(0);
    if constexpr (kStep.pairs == 0) {
        return static_cast<Sum>(add(l0, kHalfStep) >> kStep.shift);
    } else if constexpr (kStep.pairs == 1) {
        return static_cast<Sum>(add(add(l0, r0), kHalfStep) >> kStep.shift);
    } else if constexpr (isCubic(kStep)) { // floor((8 a + (a - b) + half) / 8 / ..) in steps, so that sums stay small
        const Sum a = add(l0, r0), b = add(l1, r1);
        const Sum eighth = static_cast<Sum>(add(static_cast<Sum>(Modulo(Modulo(a) - Modulo(b))), kHalfStep) >> 3);
        return static_cast<Sum>(add(a, eighth) >> (kStep.shift - 3));
    } else {
        Sum sum = add(add(times(kStep.weight[0], add(l0, r0)), times(kStep.weight[1], add(l1, r1))), kHalfStep);
        if constexpr (kStep.pairs > 2) sum = add(sum, times(kStep.weight[2], add(l2, r2)));
        return static_cast<Sum>(sum >> kStep.shift);
    }
}

/// Adds the lifting term to whole blocks of kRowWords, or subtracts it.
template <class Word, class Sum, LiftStep kStep, bool kAdd>
TESSERA_INLINE void changeBlocks(Word* __restrict target, const Sources<Word>& from, std::size_t count) {
    const Word *l0 = from.left[0], *r0 = from.right[0], *l1 = from.left[1], *r1 = from.right[1], *l2 = from.left[2],
               *r2 = from.right[2];
    const auto at = [](const Word* row, std::size_t i) { return static_cast<Sum>(row[i]); };
    for (std::size_t block = 0; block < count; block += kRowWords)
        for (std::size_t i = block; i < block + kRowWords; ++i) {
            Sum change = 0;
            if constexpr (kStep.pairs == 0)
                change = changeOf<Sum, kStep>(at(l0, i), 0, 0, 0, 0, 0);
            else if constexpr (kStep.pairs == 1)
                change = changeOf<Sum, kStep>(at(l0, i), at(r0, i), 0, 0, 0, 0);
            else if constexpr (kStep.pairs == 2)
                change = changeOf<Sum, kStep>(at(l0, i), at(r0, i), at(l1, i), at(r1, i), 0, 0);
            else
                change = changeOf<Sum, kStep>(at(l0, i), at(r0, i), at(l1, i), at(r1, i), at(l2, i), at(r2, i));
            using Modulo = std::make_unsigned_t<Word>;
            const auto was = static_cast<Modulo>(target[i]), by = static_cast<Modulo>(change);
            target[i] = static_cast<Word>(static_cast<Modulo>(kAdd ? was + by : was - by));
        }
}

/// Rows of `count` words, `stride` apart: `targets` rows to change, from `sources` rows.
template <class Word> struct RowSet {
    Word* target;
    int targets;
    const Word* source;
    int sources;
    std::size_t count, stride;
};

template <class Word, class Sum, LiftStep kStep, bool kAdd> TESSERA_INLINE void changeRows(const RowSet<Word>& set) {
    for (int i = 0; i < set.targets; ++i) {
        Sources<Word> from;
        if constexpr (kStep.pairs == 0) {
            if (i >= set.sources) break;
            from.left[0] = set.source + std::size_t(i) * set.stride;
        } else {
            const Pairs pairs = pairsAt(i, kStep.pairs, set.sources, isUpdate(kStep));
            if (pairs.none) continue;
            for (std::size_t j = 0; j < std::size_t(kStep.pairs); ++j) {
                from.left[j] = set.source + std::size_t(pairs.left[j]) * set.stride;
                from.right[j] = set.source + std::size_t(pairs.right[j]) * set.stride;
            }
        }
        changeBlocks<Word, Sum, kStep, kAdd>(set.target + std::size_t(i) * set.stride, from, set.count);
    }
}

/// The even and odd samples of some rows, padded so that loops run over whole blocks.
template <class Word> struct Lines {
    static constexpr int kRows = 16, kRoom = 32, kWords = kRoom + 64 + kRowWords + kRoom;
    alignas(64) Word evens[kRows * kWords]{};
    alignas(64) Word odds[kRows * kWords]{};
    Word* even(int row) { return evens + row * kWords + kRoom; }
    Word* odd(int row) { return odds + row * kWords + kRoom; }
};

/// Buffers for rows in blocks, interleaved and deinterleaved.
template <class Word> struct Blocks {
    Lines<Word> lines;
    alignas(64) Word whole[Lines<Word>::kRows][2 * Lines<Word>::kWords]{};
};

/// Lifting along x of `rows` rows, deinterleaved in Lines. Words beyond both ends complete the innermost pair; the few
/// sums with incomplete outer pairs are computed individually.
template <class Word> struct LineSet {
    Word* target;
    int targets;
    Word* source;
    int sources, rows;
};

/// A sum near the ends of a line: an incomplete pair and all further out take the values of the pair inside.
template <class Word, LiftStep kStep> TESSERA_INLINE std::int64_t changeAt(const Word* source, int sources, int right) {
    std::int64_t pair = std::int64_t(source[right - 1]) + source[right];
    std::int64_t sum = (std::int64_t(1) << (kStep.shift - 1)) + kStep.weight[0] * pair;
    for (int j = 1; j < kStep.pairs; ++j) {
        const int l = right - 1 - j, r = right + j;
        if (l >= 0 && r < sources) pair = std::int64_t(source[l]) + source[r];
        sum += kStep.weight[std::size_t(j)] * pair;
    }
    return sum >> kStep.shift;
}

/// Prepares all rows before it changes the first: vector loads that follow narrow stores to the same words would stall.
template <class Word, class Sum, LiftStep kStep, bool kAdd> TESSERA_INLINE void changeLines(const LineSet<Word>& set) {
    constexpr int n = kStep.pairs, kRows = Lines<Word>::kRows, kWords = Lines<Word>::kWords;
    const int targets = set.targets, sources = set.sources;
    if constexpr (n == 0) {
        const int count = std::min(targets, sources);
        std::array<Word, kRows> kept; // even samples without an odd one
        for (int row = 0; row < set.rows; ++row) kept[std::size_t(row)] = set.target[row * kWords + count];
        for (int row = 0; row < set.rows; ++row)
            changeBlocks<Word, Sum, kStep, kAdd>(set.target + row * kWords, {{set.source + row * kWords}, {}},
                                                 std::size_t(count));
        for (int row = 0; row < set.rows; ++row) set.target[row * kWords + count] = kept[std::size_t(row)];
    } else {
        if (sources < 1) return;
        constexpr int inner = isUpdate(kStep) ? 0 : 1; // the right sample of the innermost pair of i is i + inner
        const int firstEnd = n > 1 ? std::min(targets, n - inner) : 0;
        const int lastBegin = n > 1 ? std::max(firstEnd, std::min(targets, sources - n + 1 - inner)) : targets;
        std::array<Word, kRows> kept;              // for an update: the detail that it must not use
        std::array<std::array<Word, 8>, kRows> at; // new values of the targets near the ends
        for (int row = 0; row < set.rows; ++row) {
            Word* source = set.source + row * kWords;
            const Word* target = set.target + row * kWords;
            kept[std::size_t(row)] = source[sources];
            source[sources] = source[sources - 1];
            source[-1] = source[0];
            std::size_t next = 0;
            const auto change = [&](int i) {
                const std::int64_t by = changeAt<Word, kStep>(source, sources, i + inner);
                at[std::size_t(row)][next++] = static_cast<Word>(kAdd ? target[i] + by : target[i] - by);
            };
            for (int i = 0; i < firstEnd; ++i) change(i);
            for (int i = lastBegin; i < targets; ++i) change(i);
        }
        for (int row = 0; row < set.rows; ++row) {
            Word* source = set.source + row * kWords;
            Sources<Word> from;
            for (int j = 0; j < n; ++j) {
                from.left[std::size_t(j)] = source + inner - 1 - j;
                from.right[std::size_t(j)] = source + inner + j;
            }
            changeBlocks<Word, Sum, kStep, kAdd>(set.target + row * kWords, from, std::size_t(targets));
        }
        for (int row = 0; row < set.rows; ++row) {
            Word* target = set.target + row * kWords;
            set.source[row * kWords + sources] = kept[std::size_t(row)];
            std::size_t next = 0;
            for (int i = 0; i < firstEnd; ++i) target[i] = at[std::size_t(row)][next++];
            for (int i = lastBegin; i < targets; ++i) target[i] = at[std::size_t(row)][next++];
        }
    }
}

template <class Word, class Sum, LiftStep kStep> TESSERA_INLINE void rowsBody(const RowSet<Word>& set, bool add) {
    add ? changeRows<Word, Sum, kStep, true>(set) : changeRows<Word, Sum, kStep, false>(set);
}
template <class Word, class Sum, LiftStep kStep> TESSERA_INLINE void linesBody(const LineSet<Word>& set, bool add) {
    add ? changeLines<Word, Sum, kStep, true>(set) : changeLines<Word, Sum, kStep, false>(set);
}

/// One lifting step as function pointers to its loops.
template <class Word> struct Stage {
    int pairs = 0;
    void (*rows)(const RowSet<Word>&, bool add) = nullptr;
    void (*lines)(const LineSet<Word>&, bool add) = nullptr;
};

template <class Word, class Sum, LiftStep kStep> struct Portable {
    static void rows(const RowSet<Word>& set, bool add) { rowsBody<Word, Sum, kStep>(set, add); }
    static void lines(const LineSet<Word>& set, bool add) { linesBody<Word, Sum, kStep>(set, add); }
};
template <class Word, class Sum, LiftStep kStep> struct Avx2 {
    TESSERA_AVX2 static void rows(const RowSet<Word>& set, bool add) { rowsBody<Word, Sum, kStep>(set, add); }
    TESSERA_AVX2 static void lines(const LineSet<Word>& set, bool add) { linesBody<Word, Sum, kStep>(set, add); }
};
template <class Word, class Sum, LiftStep kStep> struct Avx512 {
    TESSERA_AVX512 static void rows(const RowSet<Word>& set, bool add) { rowsBody<Word, Sum, kStep>(set, add); }
    TESSERA_AVX512 static void lines(const LineSet<Word>& set, bool add) { linesBody<Word, Sum, kStep>(set, add); }
};

template <class Word, class Sum, LiftStep kStep> Stage<Word> stageFor(Cpu cpu) {
    const auto stage = [](auto loops) { return Stage<Word>{kStep.pairs, loops.rows, loops.lines}; };
    return cpu == Cpu::Avx512 ? stage(Avx512<Word, Sum, kStep>())
           : cpu == Cpu::Avx2 ? stage(Avx2<Word, Sum, kStep>())
                              : stage(Portable<Word, Sum, kStep>());
}

template <class Word, LiftStep kStep> Stage<Word> stageFor(bool wide, Cpu cpu) {
    if constexpr (sizeof(Word) == 2) {
        using Sum = std::conditional_t<sumsFitInt16(kStep), std::int16_t, std::int32_t>;
        return stageFor<Word, Sum, kStep>(cpu);
    } else {
        return wide ? stageFor<Word, std::int64_t, kStep>(cpu) : stageFor<Word, std::int32_t, kStep>(cpu);
    }
}

/// The lifting steps of a wavelet, for one word type and instruction set.
template <class Word> struct Plan {
    Stage<Word> predict, update;
    bool updates = false;

    Plan(Wavelet wavelet, bool wide, Cpu cpu) {
        withWavelet(wavelet, [&]<Wavelet kWavelet>() {
            constexpr LiftFilter kFilter = filterOf(kWavelet);
            if constexpr (!kFilter.update.antisymmetric) {
                updates = kFilter.updates;
                predict = stageFor<Word, kFilter.predict>(wide, cpu);
                if constexpr (kFilter.updates) update = stageFor<Word, kFilter.update>(wide, cpu);
            }
        });
    }
    /// Lifts across rows of `stride` words, in groups of columns that stay in the cache for all steps.
    void rows(Word* even, int evens, Word* odd, int odds, std::size_t stride, bool forward) const {
        constexpr std::size_t kColumns = 512 / sizeof(Word);
        if (odds == 0) return;
        for (std::size_t at = 0; at < stride; at += kColumns) {
            const std::size_t count = std::min(kColumns, stride - at);
            Word *e = even + at, *o = odd + at;
            const auto predicts = [&] { predict.rows({o, odds, e, evens, count, stride}, !forward); };
            if (forward) predicts();
            if (updates) update.rows({e, evens, o, usableDetails(update.pairs, evens, odds), count, stride}, forward);
            if (!forward) predicts();
        }
    }
    void lines(Lines<Word>& lines, int evens, int odds, int rows, bool forward) const {
        if (odds == 0) return;
        Word *even = lines.even(0), *odd = lines.odd(0);
        const auto predicts = [&] { predict.lines({odd, odds, even, evens, rows}, !forward); };
        if (forward) predicts();
        if (updates) update.lines({even, evens, odd, usableDetails(update.pairs, evens, odds), rows}, forward);
        if (!forward) predicts();
    }
};

/// Copies whole blocks of kRowWords, at least `count` words.
template <class Word> TESSERA_INLINE void copyBlocks(const Word* __restrict from, int count, Word* __restrict to) {
    for (int block = 0; block < count; block += kRowWords)
        for (int i = block; i < block + kRowWords; ++i) to[i] = from[i];
}
/// Deinterleaves a row of words into even and odd ones; mixRow interleaves them.
template <class Word> TESSERA_INLINE void partRow(const Word* __restrict from, int words, Word* even, Word* odd) {
    for (int block = 0; block < words / 2; block += kRowWords / 2)
        for (int i = block; i < block + kRowWords / 2; ++i) even[i] = from[2 * i], odd[i] = from[2 * i + 1];
}
template <class Word> TESSERA_INLINE void mixRow(const Word* even, const Word* odd, int words, Word* __restrict to) {
    for (int block = 0; block < words / 2; block += kRowWords / 2)
        for (int i = block; i < block + kRowWords / 2; ++i) to[2 * i] = even[i], to[2 * i + 1] = odd[i];
}

/// Position of row i if even rows come first.
int placeOf(int i, int evens) {
    return i % 2 == 0 ? i / 2 : evens + i / 2;
}

} // namespace

bool liftsBoxes(Wavelet wavelet) {
    return !filterOf(wavelet).update.antisymmetric;
}

template <class Word>
void splitBox(const Box<const Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu) {
    splitSlices<Word>([&](int z) { return in.row(0, z); }, out, wavelet, wide, cpu);
}

template <class Word>
void splitSlices(const std::function<const Word*(int z)>& sliceOf, const Box<Word>& out, Wavelet wavelet, bool wide,
                 Cpu cpu) {
    const Plan<Word> plan(wavelet, wide, cpu);
    const glm::ivec3 size = out.size;
    const int ex = (size.x + 1) / 2, ey = (size.y + 1) / 2, ez = (size.z + 1) / 2;
    const int dx = size.x / 2, dy = size.y / 2, dz = size.z / 2;
    const auto row = std::size_t(out.pitch), slice = row * std::size_t(size.y);
    const LineLifter<Word> lifter(wavelet, size.x, wide, cpu);
    std::optional<Blocks<Word>> blocks;
    if (!lifter.lifts()) blocks.emplace();
    for (int z = 0; z < size.z; ++z) {
        const Word* from = sliceOf(z);
        Word* to = out.row(0, placeOf(z, ez));
        if (!blocks) lifter.split({from, to, size.y, row});
        for (int y0 = 0; blocks && y0 < size.y; y0 += Lines<Word>::kRows) {
            auto& [lines, wholes] = *blocks;
            Word* whole = wholes[0];
            const int rows = std::min(lines.kRows, size.y - y0);
            for (int y = 0; y < rows; ++y)
                partRow(from + std::size_t(y0 + y) * row, out.pitch, lines.even(y), lines.odd(y));
            plan.lines(lines, ex, dx, rows, true);
            for (int y = 0; y < rows; ++y) {
                copyBlocks(lines.even(y), ex, whole);
                copyBlocks(lines.odd(y), dx, whole + ex);
                copyBlocks<Word>(whole, out.pitch, to + std::size_t(placeOf(y0 + y, ey)) * row);
            }
        }
        plan.rows(to, ey, to + std::size_t(ey) * row, dy, row, true);
    }
    if (dz > 0) plan.rows(out.values, ez, out.row(0, ez), dz, slice, true);
}

template <class Word> void joinBox(const Box<Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu) {
    const Plan<Word> plan(wavelet, wide, cpu);
    const glm::ivec3 size = in.size;
    const int ex = (size.x + 1) / 2, ey = (size.y + 1) / 2, ez = (size.z + 1) / 2;
    const int dx = size.x / 2, dy = size.y / 2, dz = size.z / 2;
    const auto row = std::size_t(in.pitch), slice = row * std::size_t(size.y);
    if (dz > 0) plan.rows(in.values, ez, in.row(0, ez), dz, slice, false);
    const LineLifter<Word> lifter(wavelet, size.x, wide, cpu);
    std::optional<Blocks<Word>> blocks;
    if (!lifter.lifts()) blocks.emplace();
    for (int z = 0; z < size.z; ++z) {
        Word* from = in.row(0, placeOf(z, ez));
        plan.rows(from, ey, from + std::size_t(ey) * row, dy, row, false);
        if (!blocks) lifter.join({from, out.row(0, z), size.y, row});
        for (int y0 = 0; blocks && y0 < size.y; y0 += Lines<Word>::kRows) {
            auto& [lines, whole] = *blocks;
            const int rows = std::min(lines.kRows, size.y - y0);
            for (int y = 0; y < rows; ++y)
                copyBlocks<Word>(from + std::size_t(placeOf(y0 + y, ey)) * row, in.pitch, whole[y]);
            for (int y = 0; y < rows; ++y) {
                copyBlocks<Word>(whole[y], ex, lines.even(y));
                copyBlocks<Word>(whole[y] + ex, dx, lines.odd(y));
            }
            plan.lines(lines, ex, dx, rows, false);
            for (int y = 0; y < rows; ++y) mixRow<Word>(lines.even(y), lines.odd(y), in.pitch, out.row(y0 + y, z));
        }
    }
}

template void splitBox(const Box<const std::int16_t>&, const Box<std::int16_t>&, Wavelet, bool, Cpu);
template void splitSlices(const std::function<const std::int16_t*(int)>&, const Box<std::int16_t>&, Wavelet, bool, Cpu);
template void splitBox(const Box<const std::int32_t>&, const Box<std::int32_t>&, Wavelet, bool, Cpu);
template void splitSlices(const std::function<const std::int32_t*(int)>&, const Box<std::int32_t>&, Wavelet, bool, Cpu);
template void joinBox(const Box<std::int16_t>&, const Box<std::int16_t>&, Wavelet, bool, Cpu);
template void joinBox(const Box<std::int32_t>&, const Box<std::int32_t>&, Wavelet, bool, Cpu);

} // namespace tessera::codec
