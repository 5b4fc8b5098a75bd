// Places and changes of a channel, on top of the slot reconstruct.
#include "lib/octahedral.glsl"
#include "lib/place.glsl"

const float kUnknown = -1e9; // in place of a value: absent, or not known

bool present(vec2 s) {
    return s.y >= PRESENT_COVERAGE;
}

// Change over one worldCell edge per axis, in texel units: central differences, one-sided at absent samples,
// 0 where the value `centre` at p is then kUnknown. Zero unless `needed`: the loop then ends early, which is what software GL has in place of branches.
vec3 cellGradient(int field, vec3 p, float centre, bool needed) {
    vec3 result = vec3(0.0);
    for (int axis = 0; axis < (needed && FIELD_NEAREST(field) == 0 ? axisCount : 0); ++axis) {
        vec3 offset = vec3(axis == 0, axis == 1, axis == 2) * gradientDelta;
        vec2 lower = reconstruct(field, p - offset), upper = reconstruct(field, p + offset);
        bool hasLower = present(lower), hasUpper = present(upper);
        float difference = (hasUpper ? upper.x : centre) - (hasLower ? lower.x : centre);
        float factor = hasLower && hasUpper ? 0.5 : centre > kUnknown ? 1.0 : 0.0;
        result += offset / gradientDelta * factor * difference;
    }
    return result; // gradientDelta cells are one worldCell edge on either lattice
}

// The gradient in world axes as shading uses it.
vec3 shadingGradient(vec3 perCell) {
#if NORMAL_BITS > 0
    return quantizedDirection(perCell / worldCell, NORMAL_BITS) * length(perCell / worldCell);
#else
    return perCell / worldCell;
#endif
}
