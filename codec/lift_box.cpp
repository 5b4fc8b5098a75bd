#include "codec/lift_box.h"

#include "codec/filter.h"

#include <algorithm>
#include <array>

namespace tessera::codec {

namespace {

/// Which elements a sum takes: pairs of indices, incomplete ones replaced by the pair inside them.
struct Pairs {
    std::array<int, 3> left{}, right{};
    bool none = false;
};

/// Predict: pair j of odd sample i is even (i - j, i + 1 + j) of `sources` even ones; update: details (i - 1 - j, i +
/// j) of the `sources` that were predicted from two sides.
Pairs pairsAt(int i, int count, int sources, bool update) {
    Pairs pairs;
    for (int j = 0; j < count; ++j) {
        const int l = update ? i - 1 - j : i - j, r = update ? i + j : i + 1 + j;
        const bool hasLeft = l >= 0 && l < sources, hasRight = r >= 0 && r < sources;
        const auto at = static_cast<std::size_t>(j);
        if (hasLeft && hasRight) {
            pairs.left[at] = l, pairs.right[at] = r;
        } else if (j == 0) {
            pairs.none = !hasLeft && !hasRight;
            pairs.left[0] = pairs.right[0] = hasLeft ? l : r;
        } else {
            for (int k = j; k < count; ++k) {
                pairs.left[std::size_t(k)] = pairs.left[std::size_t(j - 1)];
                pairs.right[std::size_t(k)] = pairs.right[std::size_t(j - 1)];
            }
            break;
        }
    }
    return pairs;
}

/// target[i] += or -= floor((sum of w_j (left_j[i] + right_j[i]) + half) / 2^shift) for whole blocks of kRowWords.
/// No pairs: the centre itself, left[0], with half = shift.
template <class Word> struct Sources { std::array<const Word*, 3> left{}, right{}; };

template <class Word, class Sum, int kPairs>
TESSERA_INLINE void addBody(Word* __restrict target, const Sources<Word>& from, std::size_t count, const LiftStep& step,
                            bool add) {
    const Word *l0 = from.left[0], *r0 = from.right[0], *l1 = from.left[1], *r1 = from.right[1], *l2 = from.left[2],
               *r2 = from.right[2];
    const Sum w0 = static_cast<Sum>(step.weight[0]), w1 = static_cast<Sum>(step.weight[1]),
              w2 = static_cast<Sum>(step.weight[2]);
    const int shift = step.shift;
    const Sum half = static_cast<Sum>(shift > 0 ? Sum(1) << (shift - 1) : 0);
    const Sum sign = static_cast<Sum>(add ? 0 : -1);
    count = (count + kRowWords - 1) / kRowWords * kRowWords;
    for (std::size_t i = 0; i < count; ++i) {
        Sum sum = static_cast<Sum>(Sum(l0[i]) + half);
        if constexpr (kPairs == 1) sum = static_cast<Sum>(sum + Sum(r0[i]));
        if constexpr (kPairs > 1)
            sum = static_cast<Sum>(half + w0 * static_cast<Sum>(Sum(l0[i]) + Sum(r0[i])) +
                                   w1 * static_cast<Sum>(Sum(l1[i]) + Sum(r1[i])));
        if constexpr (kPairs > 2) sum = static_cast<Sum>(sum + w2 * static_cast<Sum>(Sum(l2[i]) + Sum(r2[i])));
        const Sum change = static_cast<Sum>(((sum >> shift) ^ sign) - sign);
        target[i] = static_cast<Word>(target[i] + static_cast<Word>(change));
    }
}

template <class Word, class Sum, int kPairs>
void addPortable(Word* target, const Sources<Word>& from, std::size_t count, const LiftStep& step, bool add) {
    addBody<Word, Sum, kPairs>(target, from, count, step, add);
}
template <class Word, class Sum, int kPairs>
TESSERA_AVX2 void addAvx2(Word* target, const Sources<Word>& from, std::size_t count, const LiftStep& step, bool add) {
    addBody<Word, Sum, kPairs>(target, from, count, step, add);
}
template <class Word, class Sum, int kPairs>
TESSERA_AVX512 void addAvx512(Word* target, const Sources<Word>& from, std::size_t count, const LiftStep& step,
                              bool add) {
    addBody<Word, Sum, kPairs>(target, from, count, step, add);
}

template <class Word> using Add = void (*)(Word*, const Sources<Word>&, std::size_t, const LiftStep&, bool);

template <class Word, class Sum, int kPairs> Add<Word> addFor(Cpu cpu) {
    return cpu == Cpu::Avx512 ? addAvx512<Word, Sum, kPairs>
           : cpu == Cpu::Avx2 ? addAvx2<Word, Sum, kPairs>
                              : addPortable<Word, Sum, kPairs>;
}

/// One step with the loop that carries it out.
template <class Word> struct Stage {
    LiftStep step;
    Add<Word> add = nullptr;
};

template <class Word, class Sum> Add<Word> addOf(const LiftStep& step, Cpu cpu) {
    return step.pairs == 0   ? addFor<Word, Sum, 0>(cpu)
           : step.pairs == 1 ? addFor<Word, Sum, 1>(cpu)
           : step.pairs == 2 ? addFor<Word, Sum, 2>(cpu)
                             : addFor<Word, Sum, 3>(cpu);
}

/// Sums of single pairs of small numbers fit their words.
template <class Word> Stage<Word> stageOf(const LiftStep& step, bool wide, Cpu cpu) {
    if (wide) return {step, addOf<Word, std::int64_t>(step, cpu)};
    if (sizeof(Word) == 2 && step.pairs < 2) return {step, addOf<Word, std::int16_t>(step, cpu)};
    return {step, addOf<Word, std::int32_t>(step, cpu)};
}

/// Even and odd rows of `count` elements that lie one behind the other, `targets` of them to change.
template <class Word>
void liftRows(Word* target, int targets, const Word* source, int sources, std::size_t count, const Stage<Word>& stage,
              bool update, bool add) {
    for (int i = 0; i < targets; ++i) {
        Sources<Word> from;
        if (stage.step.pairs == 0) {
            if (i >= sources) break;
            from.left[0] = source + std::size_t(i) * count;
        } else {
            const Pairs pairs = pairsAt(i, stage.step.pairs, sources, update);
            if (pairs.none) continue;
            for (std::size_t j = 0; j < 3; ++j) {
                from.left[j] = source + std::size_t(pairs.left[j]) * count;
                from.right[j] = source + std::size_t(pairs.right[j]) * count;
            }
        }
        stage.add(target + std::size_t(i) * count, from, count, stage.step, add);
    }
}

/// The even and the odd samples of a row, with room around them, so that loops run over whole blocks.
template <class Word> struct Line {
    static constexpr int kRoom = 32, kMost = 64 + kRowWords;
    alignas(64) Word evens[kRoom + kMost + kRoom]{};
    alignas(64) Word odds[kRoom + kMost + kRoom]{};
    Word* even() { return evens + kRoom; }
    Word* odd() { return odds + kRoom; }
};

/// The same along a row: even samples and odd ones in arrays with kRoom words around them. Elements beyond both ends
/// complete the innermost pair; the few sums whose outer pairs are incomplete are made one by one.
template <class Word>
void liftLine(Word* target, int targets, Word* source, int sources, const Stage<Word>& stage, bool update, bool add) {
    Sources<Word> from;
    const int n = stage.step.pairs;
    if (n == 0) {
        from.left[0] = source;
        const int count = std::min(targets, sources);
        const Word kept = target[count]; // an even sample without an odd one
        stage.add(target, from, std::size_t(count), stage.step, add);
        target[count] = kept;
        return;
    }
    if (sources < 1) return;
    const Word kept = source[sources]; // of an update: a detail that takes no part
    source[sources] = source[sources - 1];
    source[-1] = source[0];
    const int firstEnd = n > 1 ? std::min(targets, n) : 0;
    const int lastBegin = n > 1 ? std::max(firstEnd, std::min(targets, sources - n)) : targets;
    std::array<Word, 3> first{};
    std::array<Word, 8> last{};
    for (int i = 0; i < firstEnd; ++i) first[std::size_t(i)] = target[i];
    for (int i = lastBegin; i < targets; ++i) last[std::size_t(i - lastBegin)] = target[i];
    const int inner = update ? 0 : 1; // the right sample of the innermost pair of i is i + inner
    for (int j = 0; j < n; ++j) {
        from.left[std::size_t(j)] = source + inner - 1 - j;
        from.right[std::size_t(j)] = source + inner + j;
    }
    stage.add(target, from, std::size_t(targets), stage.step, add);
    source[sources] = kept;
    const auto single = [&](int i, Word value) {
        const Pairs pairs = pairsAt(i, n, sources, update);
        target[i] = value;
        if (pairs.none) return;
        std::int64_t sum = std::int64_t(1) << (stage.step.shift - 1);
        for (std::size_t j = 0; j < std::size_t(n); ++j)
            sum += std::int64_t(stage.step.weight[j]) *
                   (std::int64_t(source[pairs.left[j]]) + std::int64_t(source[pairs.right[j]]));
        const std::int64_t change = sum >> stage.step.shift;
        target[i] = static_cast<Word>(std::int64_t(value) + (add ? change : -change));
    };
    for (int i = 0; i < firstEnd; ++i) single(i, first[std::size_t(i)]);
    for (int i = lastBegin; i < targets; ++i) single(i, last[std::size_t(i - lastBegin)]);
}

/// Details that an update may use: those predicted from two sides; all for a mean of two.
int usable(const LiftStep& update, int evens, int odds) {
    return update.pairs == 0 ? odds : std::min(odds, evens - 1);
}

/// A transform ready to run.
template <class Word> struct Plan {
    Stage<Word> predict, update;
    bool updates = false;

    Plan(Wavelet wavelet, bool wide, Cpu cpu) {
        const LiftFilter filter = filterOf(wavelet);
        updates = filter.updates;
        predict = stageOf<Word>(filter.predict, wide, cpu);
        update = stageOf<Word>(filter.update, wide, cpu);
    }
    void forwardRows(Word* even, int evens, Word* odd, int odds, std::size_t count) const {
        liftRows<Word>(odd, odds, even, evens, count, predict, false, false);
        if (updates) liftRows<Word>(even, evens, odd, usable(update.step, evens, odds), count, update, true, true);
    }
    void inverseRows(Word* even, int evens, Word* odd, int odds, std::size_t count) const {
        if (updates) liftRows<Word>(even, evens, odd, usable(update.step, evens, odds), count, update, true, false);
        liftRows<Word>(odd, odds, even, evens, count, predict, false, true);
    }
    void forwardLine(Word* even, int evens, Word* odd, int odds) const {
        if (odds == 0) return;
        liftLine<Word>(odd, odds, even, evens, predict, false, false);
        if (updates) liftLine<Word>(even, evens, odd, usable(update.step, evens, odds), update, true, true);
    }
    void inverseLine(Word* even, int evens, Word* odd, int odds) const {
        if (odds == 0) return;
        if (updates) liftLine<Word>(even, evens, odd, usable(update.step, evens, odds), update, true, false);
        liftLine<Word>(odd, odds, even, evens, predict, false, true);
    }
};

} // namespace

bool liftsBoxes(Wavelet wavelet) {
    return !filterOf(wavelet).update.antisymmetric;
}

template <class Word>
void splitBox(const Box<const Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu) {
    const Plan<Word> plan(wavelet, wide, cpu);
    const glm::ivec3 size = in.size;
    const int ex = (size.x + 1) / 2, ey = (size.y + 1) / 2, ez = (size.z + 1) / 2;
    const int dx = size.x / 2, dy = size.y / 2, dz = size.z / 2;
    const auto row = std::size_t(in.pitch), slice = row * std::size_t(size.y);
    Line<Word> line;
    Word *even = line.even(), *odd = line.odd();
    for (int z = 0; z < size.z; ++z) {
        Word* to = out.row(0, z % 2 == 0 ? z / 2 : ez + z / 2);
        for (int y = 0; y < size.y; ++y) {
            const Word* from = in.row(y, z);
            const int half = in.pitch / 2; // whole blocks
            for (int x = 0; x < half; ++x) even[x] = from[2 * x], odd[x] = from[2 * x + 1];
            plan.forwardLine(even, ex, odd, dx);
            Word* done = to + std::size_t(y % 2 == 0 ? y / 2 : ey + y / 2) * row;
            std::copy_n(even, ex, done);
            std::copy_n(odd, dx, done + ex);
        }
        if (dy > 0) plan.forwardRows(to, ey, to + std::size_t(ey) * row, dy, row);
    }
    if (dz > 0) plan.forwardRows(out.values, ez, out.row(0, ez), dz, slice);
}

template <class Word> void joinBox(const Box<Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu) {
    const Plan<Word> plan(wavelet, wide, cpu);
    const glm::ivec3 size = in.size;
    const int ex = (size.x + 1) / 2, ey = (size.y + 1) / 2, ez = (size.z + 1) / 2;
    const int dx = size.x / 2, dy = size.y / 2, dz = size.z / 2;
    const auto row = std::size_t(in.pitch), slice = row * std::size_t(size.y);
    if (dz > 0) plan.inverseRows(in.values, ez, in.row(0, ez), dz, slice);
    Line<Word> line;
    Word *even = line.even(), *odd = line.odd();
    for (int z = 0; z < size.z; ++z) {
        Word* from = in.row(0, z % 2 == 0 ? z / 2 : ez + z / 2);
        if (dy > 0) plan.inverseRows(from, ey, from + std::size_t(ey) * row, dy, row);
        for (int y = 0; y < size.y; ++y) {
            const Word* coded = from + std::size_t(y % 2 == 0 ? y / 2 : ey + y / 2) * row;
            std::copy_n(coded, ex, even);
            std::copy_n(coded + ex, dx, odd);
            plan.inverseLine(even, ex, odd, dx);
            Word* __restrict to = out.row(y, z);
            const int half = in.pitch / 2;
            for (int x = 0; x < half; ++x) to[2 * x] = even[x], to[2 * x + 1] = odd[x];
        }
    }
}

template void splitBox(const Box<const std::int16_t>&, const Box<std::int16_t>&, Wavelet, bool, Cpu);
template void splitBox(const Box<const std::int32_t>&, const Box<std::int32_t>&, Wavelet, bool, Cpu);
template void joinBox(const Box<std::int16_t>&, const Box<std::int16_t>&, Wavelet, bool, Cpu);
template void joinBox(const Box<std::int32_t>&, const Box<std::int32_t>&, Wavelet, bool, Cpu);

} // namespace tessera::codec
