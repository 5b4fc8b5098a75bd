#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

/// Packets of numbers, one in each lane of the processor's vector registers: the only file (with lanes_*.h) that knows
/// instructions. The same source is compiled for several instruction sets, each in a namespace of its own, because a
/// linker keeps one of several functions of the same name: everything that such a file defines depends on Floats.
#if defined(__AVX512F__)
#define TESSERA_LANES avx512
#elif defined(__AVX2__)
#define TESSERA_LANES avx2
#else
#define TESSERA_LANES plain
#endif

namespace tessera::vis::packet::TESSERA_LANES {

namespace raw {
#if defined(__AVX512F__)
#include "vis/lanes/lanes_avx512.h"
#elif defined(__AVX2__)
#include "vis/lanes/lanes_avx2.h"
#else
#include "vis/lanes/lanes_plain.h"
#endif
} // namespace raw

inline constexpr int kLanes = raw::kLanes, kColumns = raw::kColumns, kRows = kLanes / kColumns;

/// A yes or no in each lane.
struct Mask {
    raw::M v;
    friend Mask operator&(Mask a, Mask b) { return {raw::both(a.v, b.v)}; }
    friend Mask operator|(Mask a, Mask b) { return {raw::either(a.v, b.v)}; }
    friend Mask operator!(Mask a) { return {raw::inverse(a.v)}; }
    Mask& operator&=(Mask b) { return *this = *this & b; }
    Mask& operator|=(Mask b) { return *this = *this | b; }
};
/// Bit i: lane i.
inline unsigned bitsOf(Mask m) {
    return raw::bitsOf(m.v);
}
inline Mask maskOf(unsigned bits) {
    return {raw::maskOf(bits)};
}
inline int countOf(Mask m) {
    return __builtin_popcount(bitsOf(m));
}
inline bool anyOf(Mask m) {
    return bitsOf(m) != 0;
}

struct Ints {
    raw::I v;
    Ints() = default;
    explicit Ints(std::int32_t all) : v(raw::I{} + all) {}
    explicit Ints(raw::I lanes) : v(lanes) {}
    friend Ints operator+(Ints a, Ints b) { return Ints(a.v + b.v); }
    friend Ints operator-(Ints a, Ints b) { return Ints(a.v - b.v); }
    friend Ints operator*(Ints a, Ints b) { return Ints(a.v * b.v); }
    friend Ints operator&(Ints a, Ints b) { return Ints(a.v & b.v); }
    friend Ints operator|(Ints a, Ints b) { return Ints(a.v | b.v); }
    friend Ints operator^(Ints a, Ints b) { return Ints(a.v ^ b.v); }
    Ints& operator+=(Ints b) { return *this = *this + b; }
    friend Ints operator<<(Ints a, int by) { return Ints(a.v << by); }
    friend Ints operator>>(Ints a, int by) { return Ints(a.v >> by); }
    friend Mask operator==(Ints a, Ints b) { return {raw::equal(a.v, b.v)}; }
    friend Mask operator<(Ints a, Ints b) { return {raw::less(a.v, b.v)}; }
};

struct Floats {
    raw::F v;
    Floats() = default;
    template <class T> explicit Floats(T all) : v(raw::F{} + float(all)) {}
    explicit Floats(raw::F lanes) : v(lanes) {}
    friend Floats operator+(Floats a, Floats b) { return Floats(a.v + b.v); }
    friend Floats operator-(Floats a, Floats b) { return Floats(a.v - b.v); }
    friend Floats operator*(Floats a, Floats b) { return Floats(a.v * b.v); }
    friend Floats operator/(Floats a, Floats b) { return Floats(a.v / b.v); }
    Floats operator-() const { return Floats(-v); }
    Floats& operator+=(Floats b) { return *this = *this + b; }
    Floats& operator-=(Floats b) { return *this = *this - b; }
    Floats& operator*=(Floats b) { return *this = *this * b; }
    friend Mask operator<(Floats a, Floats b) { return {raw::less(a.v, b.v)}; }
    friend Mask operator<=(Floats a, Floats b) { return {raw::lessEqual(a.v, b.v)}; }
    friend Mask operator>(Floats a, Floats b) { return b < a; }
    friend Mask operator>=(Floats a, Floats b) { return b <= a; }
    void store(float* to) const { __builtin_memcpy(to, &v, sizeof v); }
    static Floats load(const float* from) {
        Floats out;
        __builtin_memcpy(&out.v, from, sizeof out.v);
        return out;
    }
};

inline Floats choose(Mask m, Floats a, Floats b) {
    return Floats(raw::choose(m.v, a.v, b.v));
}
inline Ints choose(Mask m, Ints a, Ints b) {
    return Ints(raw::choose(m.v, a.v, b.v));
}
/// A number that is not one counts as b.
inline Floats smaller(Floats a, Floats b) {
    return Floats(raw::smaller(a.v, b.v));
}
inline Floats larger(Floats a, Floats b) {
    return Floats(raw::larger(a.v, b.v));
}
inline Ints smaller(Ints a, Ints b) {
    return Ints(raw::smaller(a.v, b.v));
}
inline Ints larger(Ints a, Ints b) {
    return Ints(raw::larger(a.v, b.v));
}
/// Of all lanes.
inline float least(Floats a) {
    return raw::least(a.v);
}
inline Floats squareRoot(Floats a) {
    return Floats(raw::root(a.v));
}
inline Floats roundDown(Floats a) {
    return Floats(raw::roundDown(a.v));
}
inline Floats roundUp(Floats a) {
    return -roundDown(-a);
}
/// a b + c, rounded once where the processor can.
inline Floats multiplyAdd(Floats a, Floats b, Floats c) {
    return Floats(raw::multiplyAdd(a.v, b.v, c.v));
}
inline Floats toFloats(Ints a) {
    return Floats(__builtin_convertvector(a.v, raw::F));
}
/// Cuts the fraction off.
inline Ints toInts(Floats a) {
    return Ints(__builtin_convertvector(a.v, raw::I));
}
inline Floats sameBits(Ints a) {
    return Floats(raw::F(a.v));
}
inline Ints sameBits(Floats a) {
    return Ints(raw::I(a.v));
}
inline Floats magnitude(Floats a) {
    return sameBits(sameBits(a) & Ints(0x7fffffff));
}

/// 32 bits from base + index * Scale bytes; 0 in lanes that are not asked for, whose index may be anything.
template <int Scale> Ints gather(const void* base, Ints index, Mask m) {
    return Ints(raw::gather<Scale>(base, index.v, m.v));
}
inline Floats gatherFloats(const float* base, Ints index, Mask m) {
    return sameBits(gather<4>(base, index, m));
}
/// 64 bits from base + index * Scale bytes, the low and the high half; 0 in lanes that are not asked for.
struct IntPair {
    Ints low, high;
};
template <int Scale> [[gnu::always_inline]] inline IntPair gatherPairs(const void* base, Ints index, Mask m) {
    IntPair out;
    raw::gatherPairs<Scale>(base, index.v, m.v, out.low.v, out.high.v);
    return out;
}
/// Indices of loadPairs() and loadQuads(), which are best made long before them; they may be anything in lanes that are
/// not asked for. `Many`: of several reads that do not wait for each other, so that it matters less how long one takes;
/// only of loadPairs().
template <bool Many> using Spread = raw::Spread<Many>;
template <bool Many = false> [[gnu::always_inline]] inline Spread<Many> spread(Ints index, Mask m) {
    return raw::spread<Many>(index.v, m.v);
}
/// As gatherPairs(), for large data: faster where the first cache misses often, slower where it does not. Lanes that
/// are not asked for may be anything.
template <int Scale, class Spread>
[[gnu::always_inline]] inline IntPair loadPairs(const void* base, const Spread& index, Mask m) {
    IntPair out;
    raw::loadPairs<Scale>(base, index, m.v, out.low.v, out.high.v);
    return out;
}
/// Four times 32 bits from base + index * Scale bytes on.
struct IntQuad {
    Ints each[4];
};
template <int Scale>
[[gnu::always_inline]] inline IntQuad loadQuads(const void* base, const Spread<false>& index, Mask m) {
    raw::I each[4];
    raw::loadQuads<Scale>(base, index, m.v, each);
    return {{Ints(each[0]), Ints(each[1]), Ints(each[2]), Ints(each[3])}};
}
/// Bit `index` (0..255) of 8 words.
inline Mask bitAt(const std::uint32_t* words, Ints index) {
    return {raw::bitAt(words, index.v)};
}

/// Lanes hold two signed 16-bit numbers each: low a * low b + high a * high b.
inline Ints dotPairs(Ints a, Ints b) {
    return Ints(raw::dotPairs(a.v, b.v));
}
/// The low 16 bits in both halves of a lane, shifted right by one.
inline Ints lowHalves(Ints a) {
    return Ints(raw::lowHalves(a.v));
}
/// The same lanes: a + (b - a) share / 2^15, rounded; a, b and share 0 .. 2^15 - 1.
inline Ints mixPairs(Ints a, Ints b, Ints share) {
    return Ints(raw::mixPairs(a.v, b.v, share.v));
}

/// a 2^whole, a in 1/2 .. 2; 0 below 2^-126, the largest power above 2^127.
inline Floats timesPowerOfTwo(Floats a, Floats whole) {
    return Floats(raw::timesPowerOfTwo(a.v, whole.v));
}

/// Base-two logarithm of positive normal numbers, relative error below 1e-6 of the result or 1e-7 (polynomial of the
/// mantissa in sqrt(1/2) .. sqrt(2): log2 m = 2 / ln 2 (s + s^3 / 3 + ...), s = (m - 1) / (m + 1)); 0 gives -127.
inline Floats logarithm(Floats a) {
    const Ints bits = sameBits(a);
    const Ints exponent = (bits - Ints(0x3f3504f3)) >> 23; // so that the mantissa lies around 1
    const Floats m = sameBits(bits - (exponent << 23));
    const Floats s = (m - Floats(1)) / (m + Floats(1)), q = s * s;
    const Floats series = multiplyAdd(
        q,
        multiplyAdd(q, multiplyAdd(q, multiplyAdd(q, Floats(1.0 / 9), Floats(1.0 / 7)), Floats(0.2)), Floats(1.0 / 3)),
        Floats(1));
    return choose(a > Floats(0), multiplyAdd(s * Floats(2.8853900818), series, toFloats(exponent)), Floats(-127));
}
/// 2^a, relative error below 2e-7; 0 below -126 (Taylor series of the fraction around 0, -1/2 .. 1/2).
inline Floats powerOfTwo(Floats a) {
    const Floats whole = roundDown(a + Floats(0.5)), f = a - whole, q = f * f;
    const Floats low = multiplyAdd(f, Floats(6.9314718e-1), Floats(1)),
                 middle = multiplyAdd(f, Floats(5.5504109e-2), Floats(2.4022651e-1)),
                 high =
                     multiplyAdd(multiplyAdd(f, Floats(1.5403530e-4), Floats(1.3333558e-3)), f, Floats(9.6181291e-3));
    return timesPowerOfTwo(multiplyAdd(multiplyAdd(high, q, middle), q, low), whole);
}
/// base >= 0. 0 to any power above 0 is 0.
inline Floats power(Floats base, Floats exponent) {
    return choose(base > Floats(0), powerOfTwo(exponent * logarithm(base)), Floats(0));
}

/// Error below 3e-7 for angles of a few turns (Taylor series around the multiples of pi / 2).
inline Floats sine(Floats radians) {
    const Floats quarter = roundDown(multiplyAdd(radians, Floats(0.63661977), Floats(0.5)));
    const Floats x = multiplyAdd(quarter, Floats(4.3711390e-8), multiplyAdd(quarter, Floats(-1.57079637f), radians));
    const Floats q = x * x;
    const Floats odd =
        x * multiplyAdd(q, multiplyAdd(q, multiplyAdd(q, Floats(-1.0 / 5040), Floats(1.0 / 120)), Floats(-1.0 / 6)),
                        Floats(1));
    const Floats even = multiplyAdd(
        q,
        multiplyAdd(q, multiplyAdd(q, multiplyAdd(q, Floats(1.0 / 40320), Floats(-1.0 / 720)), Floats(1.0 / 24)),
                    Floats(-0.5)),
        Floats(1));
    const Ints turn = toInts(quarter);
    const Floats own = choose((turn & Ints(1)) == Ints(0), odd, even);
    return choose((turn & Ints(2)) == Ints(0), own, -own);
}
inline Floats cosine(Floats radians) {
    return sine(radians + Floats(1.5707963));
}
/// The angle of (x, y), -pi .. pi, error below 5e-7 (polynomial of Cephes' atanf, S. L. Moshier); 0 of (0, 0).
inline Floats angleOf(Floats y, Floats x) {
    const Floats wide = magnitude(x), high = magnitude(y), most = larger(wide, high);
    const Floats ratio = smaller(wide, high) / choose(most > Floats(0), most, Floats(1));
    const Mask steep = ratio > Floats(0.41421356);
    const Floats a = choose(steep, (ratio - Floats(1)) / (ratio + Floats(1)), ratio), q = a * a;
    const Floats series = multiplyAdd(
        q,
        multiplyAdd(q, multiplyAdd(q, Floats(8.05374449538e-2), Floats(-1.38776856032e-1)), Floats(1.99777106478e-1)),
        Floats(-3.33329491539e-1));
    Floats angle = multiplyAdd(series * q, a, a) + choose(steep, Floats(0.78539816), Floats(0));
    angle = choose(high > wide, Floats(1.5707963) - angle, angle);
    angle = choose(x < Floats(0), Floats(3.1415927) - angle, angle);
    return choose(y < Floats(0), -angle, angle);
}

} // namespace tessera::vis::packet::TESSERA_LANES
