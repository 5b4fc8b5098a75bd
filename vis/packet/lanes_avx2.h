// AVX2 with FMA: the operations of vis/packet/lanes.h that vector extensions of the compiler lack.
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
