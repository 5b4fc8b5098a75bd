#include "volume/bricks/smoothed_half.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace tessera::volume {

namespace {

constexpr int kBinomial[] = {1, 4, 6, 4, 1}; // of 16 along each axis
constexpr int kTapReach = 2;
constexpr float kAllWeights = 16 * 16 * 16;

/// Row `y` of slice `k` of a field, scaled to a range, with presence flags.
struct PartRows {
    const Field& field;
    double lo, scale; ///< part = (value - lo) * scale
    bool masked;

    void read(int k, int y, float* values, float* present) const {
        const std::size_t row = field.lattice.index({0, y, k}), n = std::size_t(field.lattice.size.x);
        dispatch(field.type, [&]<class T>(T) {
            const T* from = field.as<T>().data() + row;
            const auto factor = float(field.scale * scale), shift = float((field.offset - lo) * scale);
            const auto within = [](float part) { return std::min(std::max(0.0f, part), 1.0f); }; // 0 of no number
            if (std::isfinite(factor) && std::isfinite(shift))
                for (std::size_t x = 0; x < n; ++x) values[x] = within(float(from[x]) * factor + shift);
            else // ranges of subnormal floats
                for (std::size_t x = 0; x < n; ++x)
                    values[x] = within(float((field.offset + field.scale * double(from[x]) - lo) * scale));
            if (!masked) return;
            for (std::size_t x = 0; x < n; ++x) {
                bool there = field.present(row + x);
                if constexpr (std::same_as<T, float>) there = there && std::isfinite(from[x]);
                present[x] = there ? 1.0f : 0.0f;
                if (!there) values[x] = 0;
            }
        });
    }
};

/// For bytes the sums over two axes fit 16 bits: 256 * 255.
template <class Sum> TESSERA_INLINE Sum fiveWeighted(Sum a, Sum b, Sum c, Sum d, Sum e) {
    return static_cast<Sum>((a + e) + Sum(kBinomial[1]) * (b + d) + Sum(kBinomial[2]) * c);
}

/// Applies fiveWeighted along a row of `nx` numbers, at every second one. `evens`, `odds`: room for half a row.
template <class Number, class Sum>
TESSERA_INLINE void halveRow(const Number* from, std::size_t nx, Sum* evens, Sum* odds, Sum* to) {
    const std::size_t hx = (nx + 1) / 2;
    // In the middle of a row all taps are inside.
    const std::size_t first = 1, last = nx > 2 ? (nx - 3) / 2 + 1 : 0;
    for (std::size_t x = 0; x < nx / 2; ++x) evens[x] = Sum(from[2 * x]), odds[x] = Sum(from[2 * x + 1]);
    if (nx % 2 != 0) evens[hx - 1] = Sum(from[nx - 1]);
    for (std::size_t x = first; x < last; ++x)
        to[x] = fiveWeighted<Sum>(evens[x - 1], odds[x - 1], evens[x], odds[x], evens[x + 1]);
    for (std::size_t x = 0; x < hx; ++x) {
        if (x == first && last > first) x = last;
        if (x == hx) break;
        Sum taps[5];
        for (int tap = 0; tap < 5; ++tap)
            taps[tap] = Sum(from[std::clamp(2 * int(x) + tap - kTapReach, 0, int(nx) - 1)]);
        to[x] = fiveWeighted<Sum>(taps[0], taps[1], taps[2], taps[3], taps[4]);
    }
}
/// Applies it across five rows.
template <class Wide, class Sum, class Out, class Finish>
TESSERA_INLINE void weighRows(const Sum* const (&taps)[5], std::size_t count, Out* to, const Finish& finish) {
    for (std::size_t i = 0; i < count; ++i)
        to[i] = finish(fiveWeighted<Wide>(taps[0][i], taps[1][i], taps[2][i], taps[3][i], taps[4][i]));
}

/// The loops for one instruction set each.
template <bool kAvx2> struct Loops {
    template <class Number, class Sum>
    static void halve(const Number* from, std::size_t nx, Sum* evens, Sum* odds, Sum* to) {
        halveRow(from, nx, evens, odds, to);
    }
    template <class Wide, class Sum, class Out, class Finish>
    static void weigh(const Sum* const (&taps)[5], std::size_t count, Out* to, const Finish& finish) {
        weighRows<Wide>(taps, count, to, finish);
    }
};
template <> struct Loops<true> {
    template <class Number, class Sum>
    TESSERA_AVX2 static void halve(const Number* from, std::size_t nx, Sum* evens, Sum* odds, Sum* to) {
        halveRow(from, nx, evens, odds, to);
    }
    template <class Wide, class Sum, class Out, class Finish>
    TESSERA_AVX2 static void weigh(const Sum* const (&taps)[5], std::size_t count, Out* to, const Finish& finish) {
        weighRows<Wide>(taps, count, to, finish);
    }
};

/// Slices of the sublattice halved along x and y, then along z, where `finish` makes values of sums with the weights of
/// all three axes. `read(slice, y, room)` gives a row, in the given buffer, or in place.
template <class Number, class Sum, bool kAvx2, class Read, class Finish>
std::vector<float> halvedWith(glm::ivec3 size, const Read& read, const Finish& finish) {
    using Rows = Loops<kAvx2>;
    const glm::ivec3 half = (size + 1) / 2;
    const std::size_t nx = std::size_t(size.x), hx = std::size_t(half.x), slice = hx * std::size_t(half.y);
    const auto flat = std::make_unique_for_overwrite<Sum[]>(slice * std::size_t(size.z));
    std::vector<float> out(countOf(half));
    // Five rows or slices from the second before number 2 i on.
    const auto tapsAt = [](const Sum* from, int i, int count, std::size_t pitch, const Sum*(&taps)[5]) {
        for (int tap = 0; tap < 5; ++tap)
            taps[tap] = from + std::size_t(std::clamp(2 * i + tap - kTapReach, 0, count - 1)) * pitch;
    };
    parallelRanges(std::size_t(size.z), [&](std::size_t begin, std::size_t end) {
        std::vector<Number> room(nx);
        std::vector<Sum> evens(hx), odds(hx), rows(hx * std::size_t(size.y));
        const Sum* taps[5];
        for (std::size_t z = begin; z < end; ++z) {
            for (int y = 0; y < size.y; ++y)
                Rows::halve(read(int(z), y, room.data()), nx, evens.data(), odds.data(),
                            rows.data() + std::size_t(y) * hx);
            for (int y = 0; y < half.y; ++y) {
                tapsAt(rows.data(), y, size.y, hx, taps);
                Rows::template weigh<Sum>(taps, hx, flat.get() + z * slice + std::size_t(y) * hx,
                                          [](Sum sum) { return sum; });
            }
        }
    });
    parallelFor(std::size_t(half.z), [&](std::size_t z) {
        using Wide = std::conditional_t<std::same_as<Sum, float>, float, std::int32_t>;
        const Sum* taps[5];
        tapsAt(flat.get(), int(z), size.z, slice, taps);
        Rows::template weigh<Wide>(taps, slice, out.data() + z * slice, finish);
    });
    return out;
}

template <class Number, class Sum, class Read, class Finish>
std::vector<float> halved(glm::ivec3 size, Cpu cpu, const Read& read, const Finish& finish) {
    return cpu == Cpu::Portable ? halvedWith<Number, Sum, false>(size, read, finish)
                                : halvedWith<Number, Sum, true>(size, read, finish);
}

} // namespace

Smoothed smoothedHalf(const Field& field, int sublattice, const SmoothedRange& about, Cpu cpu) {
    const Lattice& lattice = field.lattice;
    const int slices = lattice.kind == LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 size = lattice.sublatticeSize(sublattice);
    const PartRows parts{field, about.range.lo, 1 / (about.range.hi - about.range.lo), about.gaps};
    Smoothed out;
    out.size = (size + 1) / 2;
    if (countOf(size) == 0) {
        out.size = glm::ivec3(0);
        return out;
    }
    if (field.type == ScalarType::U8 && about.inside && !about.gaps) { // parts are made of sums, not of samples
        const auto factor = float(field.scale * parts.scale) / kAllWeights,
                   shift = float((field.offset - parts.lo) * parts.scale);
        const std::uint8_t* samples = field.as<std::uint8_t>().data();
        out.values = halved<std::uint8_t, std::uint16_t>(
            size, cpu,
            [&](int k, int y, std::uint8_t*) {
                return samples + lattice.index({0, y, k * slices + sublattice});
            },
            [=](std::int32_t sum) { return std::min(std::max(0.0f, float(sum) * factor + shift), 1.0f); });
        return out;
    }
    const auto inAll = [](float sum) { return sum / kAllWeights; };
    if (!about.gaps) {
        out.values = halved<float, float>(
            size, cpu, [&](int k, int y, float* to) { return parts.read(k * slices + sublattice, y, to, nullptr), to; },
            inAll);
        return out;
    }
    out.values = halved<float, float>(
        size, cpu,
        [&](int k, int y, float* to) {
            std::vector<float> present(std::size_t(size.x));
            parts.read(k * slices + sublattice, y, to, present.data());
            return to;
        },
        inAll);
    out.coverage = halved<float, float>(
        size, cpu,
        [&](int k, int y, float* to) {
            std::vector<float> values(std::size_t(size.x));
            parts.read(k * slices + sublattice, y, values.data(), to);
            return to;
        },
        inAll);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        if (out.coverage[i] > 0) out.values[i] /= out.coverage[i];
    return out;
}

} // namespace tessera::volume
