// Slot reconstruct: average of the trilinear interpolations on both sublattices (with prefiltered samples:
// quasi-interpolation), or the nearest sample. Twin: linear() in volume/reconstruct/reconstruct.h.
#include "lib/sampling/bcc_nearest.glsl"

// (value, coverage) at p; absent if coverage < PRESENT_COVERAGE.
vec2 reconstructFrame(int field, vec3 p) {
    if (FIELD_NEAREST(field) == 1) return bccNearest(field, p);
    vec4 even = fetchEven(field, p), odd = fetchOdd(field, p);
    if (FIELD_COVERAGE(field) == 0) return vec2(0.5 * (even.r + odd.g), 1.0);
    float coverage = even.b + odd.a;
    return vec2((even.r + odd.g) / max(coverage, 1e-6), 0.5 * coverage);
}

#include "lib/sampling/between_times.glsl"
