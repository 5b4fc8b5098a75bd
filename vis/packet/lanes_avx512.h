// AVX-512: the operations of vis/packet/lanes.h that vector extensions of the compiler lack.
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
