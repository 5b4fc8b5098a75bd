// Places and changes of a channel, on top of the slot reconstruct.
#include "lib/octahedral.glsl"
#include "lib/place.glsl"

const float kUnknown = -1e9; // in place of a value: absent, or not known

bool present(vec2 s) {
    return s.y >= PRESENT_COVERAGE;
}
#if PARTS
bool present(Reading s) {
    return s.y >= PRESENT_COVERAGE;
}
#endif

// Edge of a cell of the level drawn at p of a reading's part.
float readEdge(int field, Reading like, vec3 p) {
    float edge = cellEdge(field, p);
#if PARTS
    for (int j = 1; j < FIELD_PARTS(field); ++j)
        if (like.z == float(j)) edge = cellEdge(FIELD_MORE(field) + j - 1, p);
#endif
    return edge;
}

// Change over one worldCell edge per axis, in texel units, by differences as volume/reconstruct/gradient.h has them, of the part
// that `like` is of: one-sided where it is absent, 0 where the value `centre` at p is then kUnknown. Zero unless
// `needed`: the loop then ends early, which is what software GL has in place of branches.
vec3 partGradient(int field, Reading like, vec3 p, float centre, bool needed) {
    vec3 result = vec3(0.0);
    holdPage(field, p);
    float edge = readEdge(field, like, dataCells(p));
    for (int i = 0; i < (needed && FIELD_NEAREST(field) == 0 ? gradientDirections : 0); ++i) {
#if GRADIENT_DIAGONAL
        vec3 direction = vec3(i == 1 ? -1.0 : 1.0, i == 2 ? -1.0 : 1.0, i == 3 ? -1.0 : 1.0);
#else
        vec3 direction = vec3(i == 0, i == 1, i == 2);
#endif
        vec3 offset = direction * (gradientReach * edge);
        vec2 lower = readPart(field, like, p - offset), upper = readPart(field, like, p + offset);
        bool hasLower = present(lower), hasUpper = present(upper);
        float difference = (hasUpper ? upper.x : centre) - (hasLower ? lower.x : centre);
        float factor = hasLower && hasUpper ? 0.5 : centre > kUnknown ? 1.0 : 0.0;
        result += direction * factor * difference;
    }
    releasePage();
    return result * (gradientScale / edge);
}

// The same of the part that p belongs to.
vec3 cellGradient(int field, vec3 p, float centre, bool needed) {
#if PARTS
    if (!needed) return vec3(0.0);
    Reading here = readAt(field, p);
    return partGradient(field, here, p, here.w >= PRESENT_COVERAGE ? here.x : kUnknown, needed);
#else
    return partGradient(field, vec2(0.0), p, centre, needed);
#endif
}

// The gradient in world axes as shading uses it.
vec3 shadingGradient(vec3 perCell) {
#if NORMAL_BITS > 0
    return quantizedDirection(perCell / worldCell, NORMAL_BITS) * length(perCell / worldCell);
#else
    return perCell / worldCell;
#endif
}
