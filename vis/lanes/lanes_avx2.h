// AVX2 with FMA: the operations of vis/lanes/lanes.h that vector extensions of the compiler lack.
using F = float __attribute__((vector_size(32)));
using I = std::int32_t __attribute__((vector_size(32)));
using M = I; ///< all bits of a lane, or none
inline constexpr int kLanes = 8, kColumns = 4;

inline M less(F a, F b) {
    return M(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
}
inline M lessEqual(F a, F b) {
    return M(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
inline M equal(I a, I b) {
    return M(_mm256_cmpeq_epi32(__m256i(a), __m256i(b)));
}
inline M less(I a, I b) {
    return M(_mm256_cmpgt_epi32(__m256i(b), __m256i(a)));
}
inline F choose(M m, F a, F b) {
    return _mm256_blendv_ps(b, a, __m256(m));
}
inline I choose(M m, I a, I b) {
    return I(_mm256_blendv_epi8(__m256i(b), __m256i(a), __m256i(m)));
}
inline unsigned bitsOf(M m) {
    return unsigned(_mm256_movemask_ps(__m256(m)));
}
inline M maskOf(unsigned bits) {
    const I each{1, 2, 4, 8, 16, 32, 64, 128};
    return equal((I{} + std::int32_t(bits)) & each, each);
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
    return _mm256_min_ps(a, b);
}
inline F larger(F a, F b) {
    return _mm256_max_ps(a, b);
}
inline I smaller(I a, I b) {
    return I(_mm256_min_epi32(__m256i(a), __m256i(b)));
}
inline I larger(I a, I b) {
    return I(_mm256_max_epi32(__m256i(a), __m256i(b)));
}
inline float least(F a) {
    const __m128 four = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)));
}
inline F root(F a) {
    return _mm256_sqrt_ps(a);
}
inline F roundDown(F a) {
    return _mm256_floor_ps(a);
}
inline F multiplyAdd(F a, F b, F c) {
    return _mm256_fmadd_ps(a, b, c);
}
template <int Scale> inline I gather(const void* base, I index, M m) {
    return I(_mm256_mask_i32gather_epi32(_mm256_setzero_si256(), static_cast<const int*>(base), __m256i(index),
                                         __m256i(m), Scale));
}
inline I dotPairs(I a, I b) {
    return I(_mm256_madd_epi16(__m256i(a), __m256i(b)));
}
template <int Scale> [[gnu::always_inline]] inline void gatherPairs(const void* base, I index, M m, I& low, I& high) {
    const auto half = [&](__m128i at, __m128i lanes) {
        return _mm256_castsi256_ps(_mm256_mask_i32gather_epi64(
            _mm256_setzero_si256(), static_cast<const long long*>(base), at, _mm256_cvtepi32_epi64(lanes), Scale));
    };
    const __m256 a = half(_mm256_castsi256_si128(__m256i(index)), _mm256_castsi256_si128(__m256i(m)));
    const __m256 b = half(_mm256_extracti128_si256(__m256i(index), 1), _mm256_extracti128_si256(__m256i(m), 1));
    const auto inOrder = [](__m256 mixed) { return I(_mm256_permute4x64_epi64(_mm256_castps_si256(mixed), 0xd8)); };
    low = inOrder(_mm256_shuffle_ps(a, b, 0x88));
    high = inOrder(_mm256_shuffle_ps(a, b, 0xdd));
}
template <bool> using Spread = I;
template <bool> [[gnu::always_inline]] inline I spread(I index, M) {
    return index;
}
template <int Scale> [[gnu::always_inline]] inline void loadPairs(const void* base, I index, M m, I& low, I& high) {
    gatherPairs<Scale>(base, index, m, low, high);
}
template <int Scale> [[gnu::always_inline]] inline void loadQuads(const void* base, const I& index, M m, I* each) {
    alignas(32) std::int32_t at[kLanes];
    _mm256_store_si256(reinterpret_cast<__m256i*>(at), __m256i(index & m));
    const auto two = [&](int i) __attribute__((always_inline)) { // of lanes i and i + 4
        const auto one = [&](int lane) __attribute__((always_inline)) {
            const char* place = static_cast<const char*>(base) + std::ptrdiff_t(at[lane]) * Scale;
            return _mm_loadu_si128(reinterpret_cast<const __m128i*>(place));
        };
        return _mm256_inserti128_si256(_mm256_castsi128_si256(one(i)), one(i + 4), 1);
    };
    const __m256i a = two(0), b = two(1), c = two(2), d = two(3);
    const __m256i ab = _mm256_unpacklo_epi32(a, b), cd = _mm256_unpacklo_epi32(c, d);
    each[0] = I(_mm256_unpacklo_epi64(ab, cd));
    each[1] = I(_mm256_unpackhi_epi64(ab, cd));
    const __m256i ab2 = _mm256_unpackhi_epi32(a, b), cd2 = _mm256_unpackhi_epi32(c, d);
    each[2] = I(_mm256_unpacklo_epi64(ab2, cd2));
    each[3] = I(_mm256_unpackhi_epi64(ab2, cd2));
}
inline M bitAt(const std::uint32_t* words, I index) {
    const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words));
    const __m256i word = _mm256_permutevar8x32_epi32(all, __m256i(index >> 5));
    return M(_mm256_sllv_epi32(word, __m256i(31 - (index & 31)))) < 0;
}
inline I mixPairs(I a, I b, I share) {
    const __m256i way = _mm256_mulhrs_epi16(_mm256_sub_epi16(__m256i(b), __m256i(a)), __m256i(share));
    return I(_mm256_add_epi16(__m256i(a), way));
}
inline I lowHalves(I a) {
    const I both{0x01000100, 0x05040504, 0x09080908, 0x0d0c0d0c, 0x01000100, 0x05040504, 0x09080908, 0x0d0c0d0c};
    return I(_mm256_srli_epi16(_mm256_shuffle_epi8(__m256i(a), __m256i(both)), 1));
}
inline F timesPowerOfTwo(F a, F whole) {
    const F most = smaller(whole, F{} + 127.0f);
    const I bits = (__builtin_convertvector(larger(most, F{} - 127.0f), I) + 127) << 23;
    return a * F(bits); // 2^-127 is 0
}
