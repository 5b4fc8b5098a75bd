// AVX-512: the operations of vis/lanes/lanes.h that vector extensions of the compiler lack.
using F = float __attribute__((vector_size(64)));
using I = std::int32_t __attribute__((vector_size(64)));
using M = __mmask16;
inline constexpr int kLanes = 16, kColumns = 4;

inline M less(F a, F b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
inline M lessEqual(F a, F b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
inline M equal(I a, I b) {
    return _mm512_cmpeq_epi32_mask(__m512i(a), __m512i(b));
}
inline M less(I a, I b) {
    return _mm512_cmplt_epi32_mask(__m512i(a), __m512i(b));
}
inline F choose(M m, F a, F b) {
    return _mm512_mask_blend_ps(m, b, a);
}
inline I choose(M m, I a, I b) {
    return I(_mm512_mask_blend_epi32(m, __m512i(b), __m512i(a)));
}
inline unsigned bitsOf(M m) {
    return m;
}
inline M maskOf(unsigned bits) {
    return M(bits);
}
inline M both(M a, M b) {
    return M(a & b);
}
inline M either(M a, M b) {
    return M(a | b);
}
inline M inverse(M a) {
    return M(~a);
}
inline F smaller(F a, F b) {
    return _mm512_min_ps(a, b);
}
inline F larger(F a, F b) {
    return _mm512_max_ps(a, b);
}
inline I smaller(I a, I b) {
    return I(_mm512_min_epi32(__m512i(a), __m512i(b)));
}
inline I larger(I a, I b) {
    return I(_mm512_max_epi32(__m512i(a), __m512i(b)));
}
inline float least(F a) {
    return _mm512_reduce_min_ps(a);
}
inline F root(F a) {
    return _mm512_sqrt_ps(a);
}
inline F roundDown(F a) {
    return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
inline F multiplyAdd(F a, F b, F c) {
    return _mm512_fmadd_ps(a, b, c);
}
template <int Scale> inline I gather(const void* base, I index, M m) {
    return I(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), m, __m512i(index), base, Scale));
}
inline I dotPairs(I a, I b) {
    return I(_mm512_madd_epi16(__m512i(a), __m512i(b)));
}
template <int Scale> [[gnu::always_inline]] inline void gatherPairs(const void* base, I index, M m, I& low, I& high) {
    const __m512i none = _mm512_setzero_si512(), at = __m512i(index);
    const auto half = [&](__m256i own, unsigned lanes) {
        return _mm512_mask_i32gather_epi64(none, __mmask8(lanes), own, base, Scale);
    };
    const __m512i a = half(_mm512_castsi512_si256(at), m), b = half(_mm512_extracti64x4_epi64(at, 1), m >> 8u);
    const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    low = I(_mm512_permutex2var_epi32(a, even, b));
    high = I(_mm512_permutex2var_epi32(a, _mm512_or_si512(even, _mm512_set1_epi32(1)), b));
}
/// Whether gather instructions are the fastest way for many reads: on Intel's processors they take 0.8 of the time of
/// loads of single lanes, but longer until the first is done; on Zen 4 1.6 times as long where the first cache misses.
inline const bool kGathersFast = [] {
    __builtin_cpu_init();
    return __builtin_cpu_is("intel") != 0;
}();
template <bool Many> struct Spread {
    alignas(64) std::int32_t at[kLanes]; ///< in memory, for loads of single lanes
};
template <> struct Spread<true> {
    I index;
    Spread<false> lanes; ///< unless gathers are fast
};
template <bool Many> [[gnu::always_inline]] inline Spread<Many> spread(I index, M m) {
    Spread<Many> out;
    if constexpr (Many) {
        out.index = index;
        if (!kGathersFast) out.lanes = spread<false>(index, m);
    } else {
        _mm512_store_si512(out.at, _mm512_maskz_mov_epi32(m, __m512i(index)));
        asm volatile(""
                     : "+m"(out.at)); // else the compiler takes the lanes out of the register, by two operations each
    }
    return out;
}
template <int Scale>
[[gnu::always_inline]] inline void loadPairs(const void* base, const Spread<false>& index, M, I& low, I& high) {
    const std::int32_t* at = index.at;
    const auto place = [&](int i) __attribute__((always_inline)) {
        return static_cast<const char*>(base) + std::ptrdiff_t(at[i]) * Scale;
    };
    const auto two = [&](int i) __attribute__((always_inline)) {
        const __m128i first = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(place(i)));
        return _mm_castpd_si128(_mm_loadh_pd(_mm_castsi128_pd(first), reinterpret_cast<const double*>(place(i + 1))));
    };
    const auto eight = [&](int i) __attribute__((always_inline)) { // lanes i, i + 1, i + 4, i + 5, ...
        const auto four = [&](int j) __attribute__((always_inline)) {
            return _mm256_inserti128_si256(_mm256_castsi128_si256(two(j)), two(j + 4), 1);
        };
        return _mm512_castsi512_ps(_mm512_inserti64x4(_mm512_castsi256_si512(four(i)), four(i + 8), 1));
    };
    const __m512 a = eight(0), b = eight(2);
    low = I(_mm512_shuffle_ps(a, b, 0x88));
    high = I(_mm512_shuffle_ps(a, b, 0xdd));
}
template <int Scale>
[[gnu::always_inline]] inline void loadPairs(const void* base, const Spread<true>& index, M m, I& low, I& high) {
    if (kGathersFast)
        gatherPairs<Scale>(base, index.index, m, low, high);
    else
        loadPairs<Scale>(base, index.lanes, m, low, high);
}
template <int Scale>
[[gnu::always_inline]] inline void loadQuads(const void* base, const Spread<false>& index, M, I* each) {
    const auto four = [&](int i) __attribute__((always_inline)) { // of lanes i, i + 4, i + 8, i + 12
        const auto one = [&](int lane) __attribute__((always_inline)) {
            const char* place = static_cast<const char*>(base) + std::ptrdiff_t(index.at[lane]) * Scale;
            return _mm_loadu_si128(reinterpret_cast<const __m128i*>(place));
        };
        __m512i out = _mm512_castsi128_si512(one(i));
        out = _mm512_inserti32x4(out, one(i + 4), 1);
        out = _mm512_inserti32x4(out, one(i + 8), 2);
        return _mm512_inserti32x4(out, one(i + 12), 3);
    };
    const __m512i a = four(0), b = four(1), c = four(2), d = four(3);
    const __m512i ab = _mm512_unpacklo_epi32(a, b), cd = _mm512_unpacklo_epi32(c, d);
    each[0] = I(_mm512_unpacklo_epi64(ab, cd));
    each[1] = I(_mm512_unpackhi_epi64(ab, cd));
    const __m512i ab2 = _mm512_unpackhi_epi32(a, b), cd2 = _mm512_unpackhi_epi32(c, d);
    each[2] = I(_mm512_unpacklo_epi64(ab2, cd2));
    each[3] = I(_mm512_unpackhi_epi64(ab2, cd2));
}
inline M bitAt(const std::uint32_t* words, I index) {
    const __m512i all = _mm512_broadcast_i64x4(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(words)));
    const __m512i word = _mm512_permutexvar_epi32(__m512i(index >> 5), all);
    return _mm512_test_epi32_mask(_mm512_srlv_epi32(word, __m512i(index & 31)), _mm512_set1_epi32(1));
}
inline I mixPairs(I a, I b, I share) {
    const __m512i way = _mm512_mulhrs_epi16(_mm512_sub_epi16(__m512i(b), __m512i(a)), __m512i(share));
    return I(_mm512_add_epi16(__m512i(a), way));
}
inline I lowHalves(I a) {
    const __m512i both = _mm512_set4_epi32(0x0d0c0d0c, 0x09080908, 0x05040504, 0x01000100);
    return I(_mm512_srli_epi16(_mm512_shuffle_epi8(__m512i(a), both), 1));
}
inline F timesPowerOfTwo(F a, F whole) {
    return _mm512_scalef_ps(a, whole);
}
