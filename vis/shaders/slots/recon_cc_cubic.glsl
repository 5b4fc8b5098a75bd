// Slot reconstruct: tricubic B-spline on CC, over coefficients; trilinear or the nearest sample for fields without
// these. Twin: cubic() in volume/reconstruct/cubic.h.
#include "lib/sampling/cubic.glsl"

// (value, coverage) at p; absent if coverage < PRESENT_COVERAGE.
vec2 reconstructFrame(int field, vec3 p) {
    vec4 texel;
    if (FIELD_NEAREST(field) == 1)
        texel = fetchTexel(field, ivec3(floor(sublatticeIndex(field, p, 0) + 0.5)), p);
    else if (FIELD_CUBIC(field) == 1)
        texel = cubicSublattice(field, p, 0);
    else
        texel = fetchEven(field, p);
    if (FIELD_COVERAGE(field) == 0) return vec2(texel.r, 1.0);
    return vec2(texel.r / max(texel.g, 1e-6), texel.g);
}

#include "lib/sampling/between_times.glsl"
