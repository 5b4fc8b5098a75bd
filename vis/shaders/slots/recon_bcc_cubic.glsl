// Slot reconstruct: mean of the tricubic B-splines of both sublattices, over coefficients; of the trilinear
// interpolations, or the nearest sample, for fields without these. Twin: cubic() in volume/reconstruct/cubic.h.
#include "lib/sampling/bcc_nearest.glsl"
#include "lib/sampling/cubic.glsl"

// (value, coverage) at p; absent if coverage < PRESENT_COVERAGE.
vec2 reconstructFrame(int field, vec3 p) {
    if (FIELD_NEAREST(field) == 1) return bccNearest(field, p);
    vec4 even, odd;
    if (FIELD_CUBIC(field) == 1) {
        even = cubicSublattice(field, p, 0);
        odd = cubicSublattice(field, p, 1);
    } else {
        even = fetchEven(field, p);
        odd = fetchOdd(field, p);
    }
    if (FIELD_COVERAGE(field) == 0) return vec2(0.5 * (even.r + odd.g), 1.0);
    float coverage = even.b + odd.a;
    return vec2((even.r + odd.g) / max(coverage, 1e-6), 0.5 * coverage);
}

#include "lib/sampling/between_times.glsl"
