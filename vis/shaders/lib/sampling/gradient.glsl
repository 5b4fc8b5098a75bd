// Samples and gradients of a channel, based on the slot reconstruct.
#include "lib/sampling/octahedral.glsl"
#include "lib/sampling/place.glsl"

const float kUnknown = -1e9; // replaces a value that is absent or unknown
const float kSmoothDepth = 0.5;

bool present(vec2 s) {
    return s.y >= PRESENT_COVERAGE;
}
#if PARTS
bool present(Reading s) {
    return s.y >= PRESENT_COVERAGE;
}
#endif

// Cell edge, at p, of the level drawn for the part of a reading.
float readEdge(int field, Reading like, vec3 p) {
    float edge = cellEdge(field, p);
#if PARTS
    for (int j = 1; j < FIELD_PARTS(field); ++j)
        if (like.z == float(j)) edge = cellEdge(FIELD_MORE(field) + j - 1, p);
#endif
    return edge;
}

// The difference between p - offset and p + offset within the part of `like`, halved: one-sided where one of them is
// absent, 0 if then the value `centre` at p is kUnknown too.
float halfDifference(int field, Reading like, vec3 lower, vec3 upper, float centre) {
    vec2 below = readPart(field, like, lower), above = readPart(field, like, upper);
    bool hasBelow = present(below), hasAbove = present(above);
    float difference = (hasAbove ? above.x : centre) - (hasBelow ? below.x : centre);
    return difference * (hasBelow && hasAbove ? 0.5 : centre > kUnknown ? 1.0 : 0.0);
}

// Diagonals of the cube.
vec3 diagonal(int i) {
    return vec3(i == 1 ? -1.0 : 1.0, i == 2 ? -1.0 : 1.0, i == 3 ? -1.0 : 1.0);
}

// Gradient in texel units per worldCell edge, by the differences of volume/reconstruct/gradient.h. Zero unless `needed`,
// which ends the loop early; software GL executes both sides of a branch.
vec3 partGradient(int field, Reading like, vec3 p, float centre, bool needed) {
    vec3 result = vec3(0.0);
    holdPage(field, p);
    float edge = readEdge(field, like, dataCells(p));
    for (int i = 0; i < (needed && FIELD_NEAREST(field) == 0 ? gradientDirections : 0); ++i) {
#if GRADIENT_DIAGONAL
        vec3 direction = diagonal(i);
#else
        vec3 direction = vec3(i == 0, i == 1, i == 2);
#endif
        vec3 offset = direction * (gradientReach * edge);
        result += direction * halfDifference(field, like, p - offset, p + offset, centre);
    }
    releasePage();
    return result * (gradientScale / edge);
}

// The same of a smoothed field: smoothGradient() of volume/reconstruct/gradient.h. `scale`: factor to change per
// worldCell. Positions are limited to the box, beyond which bricks hold no samples from two texels on.
vec3 smoothGradient(int field, Reading like, vec3 p, float centre, vec3 narrow, float reach, float scale, bool needed) {
    vec3 normal = dot(narrow, narrow) > 0.0 ? normalize(narrow) : vec3(0.0), sum = vec3(0.0);
    vec3 end = toCells(-halfSize), other = toCells(halfSize), lo = min(end, other), hi = max(end, other);
    float edge = readEdge(field, like, dataCells(p));
    for (int i = 0; i < (needed && FIELD_NEAREST(field) == 0 ? diagonals : 0); ++i) {
        vec3 way = diagonal(i), offset = reach * edge * (way - (1.0 - kSmoothDepth) * dot(way, normal) * normal);
        sum += way * halfDifference(field, like, clamp(p - offset, lo, hi), clamp(p + offset, lo, hi), centre);
    }
    sum = (sum + (1.0 / kSmoothDepth - 1.0) * dot(sum, normal) * normal) * (scale / edge);
    float kept = dot(sum, narrow) / max(dot(narrow, narrow), 1e-30);
    return mix(narrow, sum, smoothstep(0.1, 0.4, kept));
}

// The same for the part that p belongs to.
vec3 cellGradient(int field, vec3 p, float centre, bool needed) {
#if PARTS
    if (!needed) return vec3(0.0);
    Reading here = readAt(field, p);
    return partGradient(field, here, p, here.w >= PRESENT_COVERAGE ? here.x : kUnknown, needed);
#else
    return partGradient(field, vec2(0.0), p, centre, needed);
#endif
}

// The gradient in world axes for shading, quantised if requested.
vec3 shadingGradient(vec3 perCell) {
#if NORMAL_BITS > 0
    return quantizedDirection(perCell / worldCell, NORMAL_BITS) * length(perCell / worldCell);
#else
    return perCell / worldCell;
#endif
}
