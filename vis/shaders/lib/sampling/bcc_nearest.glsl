// The nearest BCC sample, ties to the even sublattice: (value, coverage). Twin: nearest() in
// volume/reconstruct/reconstruct.h.
vec2 bccNearest(int field, vec3 p) {
    vec3 even = sublatticeIndex(field, p, 0), odd = sublatticeIndex(field, p, 1);
    vec3 atEven = floor(even + 0.5), atOdd = floor(odd + 0.5);
    vec3 a = atEven - even, b = atOdd - odd;
    bool second = dot(b, b) < dot(a, a);
    vec4 texel = fetchTexel(field, ivec3(second ? atOdd : atEven), p);
    vec2 found = second ? texel.ga : texel.rb;
    return FIELD_COVERAGE(field) == 0 ? vec2(found.x, 1.0) : found;
}
