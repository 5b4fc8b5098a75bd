#include "codec/wavelet/lift_rows.h"

#include <algorithm>
#include <type_traits>

namespace tessera::codec {

namespace {

/// The rows of a sum, and flags of their samples, which are null where no sample is absent.
struct PairRows {
    const std::uint32_t *left[3], *right[3];
    const std::uint8_t *hasLeft[3], *hasRight[3];
};

/// The weights of a sum, which are 0 beyond its pairs, and its rounding.
template <class Sum> struct PairWeights {
    using Modulo = std::make_unsigned_t<Sum>;
    Modulo w0, w1, w2, half;
    int shift;
    std::uint32_t sign;

    PairWeights(const LiftStep& step, std::uint32_t by)
        : w0(of(step, 0)), w1(of(step, 1)), w2(of(step, 2)), half(Modulo(1) << (step.shift - 1)), shift(step.shift),
          sign(by) {}
    static Modulo of(const LiftStep& step, int j) {
        return j < step.pairs ? static_cast<Modulo>(static_cast<Sum>(step.weight[std::size_t(j)])) : Modulo(0);
    }
    TESSERA_INLINE std::uint32_t change(Modulo sum) const {
        return sign * static_cast<std::uint32_t>(static_cast<Sum>(sum) >> shift);
    }
};

/// A word as a sum, modulo its type.
template <class Sum> TESSERA_INLINE std::make_unsigned_t<Sum> termOf(std::uint32_t word) {
    return static_cast<std::make_unsigned_t<Sum>>(static_cast<Sum>(static_cast<std::int32_t>(word)));
}

template <class Sum, int kPairs>
TESSERA_INLINE void changeRow(const PairRows& of, const PairWeights<Sum>& by, int lanes, std::uint32_t* __restrict to) {
    using Modulo = std::make_unsigned_t<Sum>;
    const std::uint32_t *l0 = of.left[0], *r0 = of.right[0], *l1 = of.left[1], *r1 = of.right[1], *l2 = of.left[2],
                        *r2 = of.right[2];
    for (int i = 0; i < lanes; ++i) {
        Modulo sum = by.half + by.w0 * (termOf<Sum>(l0[i]) + termOf<Sum>(r0[i]));
        if constexpr (kPairs > 1) sum += by.w1 * (termOf<Sum>(l1[i]) + termOf<Sum>(r1[i]));
        if constexpr (kPairs > 2) sum += by.w2 * (termOf<Sum>(l2[i]) + termOf<Sum>(r2[i]));
        to[i] += by.change(sum);
    }
}

/// The same with absent samples: flags choose, so that the loop has no branches.
template <class Sum, int kPairs>
TESSERA_INLINE void changeMasked(const PairRows& of, const PairWeights<Sum>& by, const std::uint8_t* wanted, int lanes,
                                 std::uint32_t* __restrict to) {
    using Modulo = std::make_unsigned_t<Sum>;
    const std::uint32_t *l0 = of.left[0], *r0 = of.right[0], *l1 = of.left[1], *r1 = of.right[1], *l2 = of.left[2],
                        *r2 = of.right[2];
    const std::uint8_t *hl0 = of.hasLeft[0], *hr0 = of.hasRight[0], *hl1 = of.hasLeft[1], *hr1 = of.hasRight[1],
                       *hl2 = of.hasLeft[2], *hr2 = of.hasRight[2];
    const auto flag = [](std::uint8_t has) { return has != 0 ? ~0u : 0u; };
    const auto choose = [](std::uint32_t if1, std::uint32_t a, std::uint32_t b) { return (a & if1) | (b & ~if1); };
    for (int i = 0; i < lanes; ++i) {
        const std::uint32_t hasLeft = flag(hl0[i]), hasRight = flag(hr0[i]);
        std::uint32_t left = choose(hasLeft, l0[i], r0[i]), right = choose(hasRight, r0[i], l0[i]);
        Modulo sum = by.half + by.w0 * (termOf<Sum>(left) + termOf<Sum>(right));
        std::uint32_t goesOn = ~0u; // no pair further in was incomplete
        if constexpr (kPairs > 1) {
            goesOn = flag(hl1[i]) & flag(hr1[i]);
            left = choose(goesOn, l1[i], left), right = choose(goesOn, r1[i], right);
            sum += by.w1 * (termOf<Sum>(left) + termOf<Sum>(right));
        }
        if constexpr (kPairs > 2) {
            goesOn &= flag(hl2[i]) & flag(hr2[i]);
            left = choose(goesOn, l2[i], left), right = choose(goesOn, r2[i], right);
            sum += by.w2 * (termOf<Sum>(left) + termOf<Sum>(right));
        }
        to[i] += by.change(sum) & flag(wanted[i]) & (hasLeft | hasRight);
    }
}

template <class Sum, int kPairs>
TESSERA_INLINE void rowBody(const PairRows& of, const PairWeights<Sum>& by, const std::uint8_t* wanted, int lanes,
                            std::uint32_t* to) {
    wanted ? changeMasked<Sum, kPairs>(of, by, wanted, lanes, to) : changeRow<Sum, kPairs>(of, by, lanes, to);
}

template <class Sum, int kPairs> struct PairLoops {
    static void portable(const PairRows& of, const PairWeights<Sum>& by, const std::uint8_t* wanted, int lanes,
                         std::uint32_t* to) {
        rowBody<Sum, kPairs>(of, by, wanted, lanes, to);
    }
    TESSERA_AVX2 static void avx2(const PairRows& of, const PairWeights<Sum>& by, const std::uint8_t* wanted, int lanes,
                                  std::uint32_t* to) {
        rowBody<Sum, kPairs>(of, by, wanted, lanes, to);
    }
    TESSERA_AVX512 static void avx512(const PairRows& of, const PairWeights<Sum>& by, const std::uint8_t* wanted,
                                      int lanes, std::uint32_t* to) {
        rowBody<Sum, kPairs>(of, by, wanted, lanes, to);
    }
    static auto of(Cpu cpu) { return cpu == Cpu::Avx512 ? avx512 : cpu == Cpu::Avx2 ? avx2 : portable; }
};

template <class Sum>
void applyAll(const LiftStep& step, bool update, const Rows& target, const Rows& source, std::uint32_t sign,
              const std::uint8_t* flags, const std::uint8_t* none, Cpu cpu) {
    const PairWeights<Sum> by(step, sign);
    const auto change = step.pairs == 1   ? PairLoops<Sum, 1>::of(cpu)
                        : step.pairs == 2 ? PairLoops<Sum, 2>::of(cpu)
                                          : PairLoops<Sum, 3>::of(cpu);
    const auto pairs = static_cast<std::size_t>(step.pairs);
    const int sources = update && !flags ? usableDetails(step.pairs, target.rows, source.rows) : source.rows;
    const auto valuesOf = [&](int row) { return source.values + std::ptrdiff_t(row) * source.lanes; };
    for (int row = 0; row < target.rows; ++row) {
        PairRows of{};
        if (flags) {
            // Rows beyond the ends are absent.
            const auto place = [&](int at, const std::uint32_t*& values, const std::uint8_t*& has) {
                const bool inside = at >= 0 && at < sources;
                values = valuesOf(inside ? at : 0);
                has = inside ? flags + std::ptrdiff_t(at) * source.lanes : none;
            };
            for (std::size_t j = 0; j < pairs; ++j) {
                place(row - int(j) - (update ? 1 : 0), of.left[j], of.hasLeft[j]);
                place(row + int(j) + (update ? 0 : 1), of.right[j], of.hasRight[j]);
            }
        } else {
            const Pairs at = pairsAt(row, step.pairs, sources, update);
            if (at.none) continue;
            for (std::size_t j = 0; j < pairs; ++j)
                of.left[j] = valuesOf(at.left[j]), of.right[j] = valuesOf(at.right[j]);
        }
        const std::ptrdiff_t first = std::ptrdiff_t(row) * target.lanes;
        change(of, by, flags ? target.present + first : nullptr, target.lanes, target.values + first);
    }
}

/// Flags of the details that an update may use: those predicted from both sides. Appended to a row of zeros.
void markUsable(const Rows& even, const Rows& odd, std::vector<std::uint8_t>& out) {
    const auto lanes = static_cast<std::size_t>(even.lanes);
    out.assign(lanes * (static_cast<std::size_t>(odd.rows) + 1), 0);
    for (int row = 0; row < std::min(odd.rows, even.rows - 1); ++row) {
        const std::uint8_t* const before = even.present + static_cast<std::size_t>(row) * lanes;
        const std::uint8_t* const own = odd.present + static_cast<std::size_t>(row) * lanes;
        std::uint8_t* const to = out.data() + static_cast<std::size_t>(row + 1) * lanes;
        for (std::size_t i = 0; i < lanes; ++i) to[i] = before[i] != 0 && before[i + lanes] != 0 && own[i] != 0 ? 1 : 0;
    }
}

} // namespace

void applyPairs(const LiftStep& step, bool update, const Rows& target, const Rows& source, std::uint32_t sign,
                bool wide, std::vector<std::uint8_t>& usable, Cpu cpu) {
    if (source.rows < 1) return;
    const std::uint8_t* flags = nullptr;
    if (target.present) {
        if (update)
            markUsable(target, source, usable);
        else
            usable.assign(static_cast<std::size_t>(source.lanes), 0);
        flags = update ? usable.data() + source.lanes : source.present;
    }
    wide ? applyAll<std::int64_t>(step, update, target, source, sign, flags, usable.data(), cpu)
         : applyAll<std::int32_t>(step, update, target, source, sign, flags, usable.data(), cpu);
}

} // namespace tessera::codec
