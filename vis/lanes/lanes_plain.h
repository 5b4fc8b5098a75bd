// Any processor: the operations of vis/lanes/lanes.h that vector extensions of the compiler lack, as loops.
using F = float __attribute__((vector_size(16)));
using I = std::int32_t __attribute__((vector_size(16)));
using M = I; ///< all bits of a lane, or none
inline constexpr int kLanes = 4, kColumns = 2;

inline M less(F a, F b) {
    return a < b;
}
inline M lessEqual(F a, F b) {
    return a <= b;
}
inline M equal(I a, I b) {
    return a == b;
}
inline M less(I a, I b) {
    return a < b;
}
inline I choose(M m, I a, I b) {
    return (m & a) | (~m & b);
}
inline F choose(M m, F a, F b) {
    return F(choose(m, I(a), I(b)));
}
inline unsigned bitsOf(M m) {
    return unsigned((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
}
inline M maskOf(unsigned bits) {
    const I each{1, 2, 4, 8};
    return ((I{} + std::int32_t(bits)) & each) == each;
}
inline M both(M a, M b) {
    return a & b;
}
inline M either(M a, M b) {
    return a | b;
}
inline M inverse(M a) {
    return ~a;
}
inline F smaller(F a, F b) {
    return choose(a < b, a, b);
}
inline F larger(F a, F b) {
    return choose(a > b, a, b);
}
inline I smaller(I a, I b) {
    return choose(a < b, a, b);
}
inline I larger(I a, I b) {
    return choose(a > b, a, b);
}
inline float least(F a) {
    float out = a[0];
    for (int i = 1; i < kLanes; ++i) out = a[i] < out ? a[i] : out;
    return out;
}
inline F root(F a) {
    for (int i = 0; i < kLanes; ++i) a[i] = __builtin_sqrtf(a[i]);
    return a;
}
inline F roundDown(F a) { // |a| < 2^31
    const F cut = __builtin_convertvector(__builtin_convertvector(a, I), F);
    return cut - choose(cut > a, F{} + 1.0f, F{});
}
inline F multiplyAdd(F a, F b, F c) {
    return a * b + c;
}
template <int Scale> inline I gather(const void* base, I index, M m) {
    I out{};
    for (int i = 0; i < kLanes; ++i) {
        std::int32_t value = 0;
        if (m[i]) __builtin_memcpy(&value, static_cast<const char*>(base) + std::ptrdiff_t(index[i]) * Scale, 4);
        out[i] = value;
    }
    return out;
}
inline I dotPairs(I a, I b) {
    I out{};
    for (int i = 0; i < kLanes; ++i)
        out[i] = std::int32_t(std::int16_t(a[i])) * std::int16_t(b[i]) + (a[i] >> 16) * (b[i] >> 16);
    return out;
}
template <int Scale> [[gnu::always_inline]] inline void gatherPairs(const void* base, I index, M m, I& low, I& high) {
    for (int i = 0; i < kLanes; ++i) {
        std::int32_t values[2] = {0, 0};
        if (m[i]) __builtin_memcpy(values, static_cast<const char*>(base) + std::ptrdiff_t(index[i]) * Scale, 8);
        low[i] = values[0];
        high[i] = values[1];
    }
}
template <bool> using Spread = I;
template <bool> [[gnu::always_inline]] inline I spread(I index, M) {
    return index;
}
template <int Scale> [[gnu::always_inline]] inline void loadPairs(const void* base, I index, M m, I& low, I& high) {
    gatherPairs<Scale>(base, index, m, low, high);
}
template <int Scale> [[gnu::always_inline]] inline void loadQuads(const void* base, I index, M m, I* each) {
    for (int i = 0; i < kLanes; ++i) {
        std::int32_t values[4] = {0, 0, 0, 0};
        if (m[i]) __builtin_memcpy(values, static_cast<const char*>(base) + std::ptrdiff_t(index[i]) * Scale, 16);
        for (int n = 0; n < 4; ++n) each[n][i] = values[n];
    }
}
inline M bitAt(const std::uint32_t* words, I index) {
    M out{};
    for (int i = 0; i < kLanes; ++i) out[i] = -std::int32_t(words[index[i] >> 5] >> (index[i] & 31) & 1);
    return out;
}
inline I mixPairs(I a, I b, I share) {
    using Halves = std::int16_t __attribute__((vector_size(16)));
    const Halves from = Halves(a), to = Halves(b), part = Halves(share);
    Halves out{};
    for (int i = 0; i < 2 * kLanes; ++i)
        out[i] = std::int16_t(from[i] + (((to[i] - from[i]) * part[i] + (1 << 14)) >> 15));
    return I(out);
}
inline I lowHalves(I a) {
    const I low = (a >> 1) & 0x7fff;
    return low | low << 16;
}
inline F timesPowerOfTwo(F a, F whole) {
    const F most = smaller(whole, F{} + 127.0f);
    const I bits = (__builtin_convertvector(larger(most, F{} - 127.0f), I) + 127) << 23;
    return a * F(bits); // 2^-127 is 0
}
