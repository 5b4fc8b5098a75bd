// Effects of the scene's lenses at a world point; twins: lensAction, bend and confine in vis/scene/lens.h.
#include "lib/sampling/lens.glsl"
#include "lib/bindings/lens_bindings.glsl"

#if LENSES > 0
vec3 lensPlace(int i, vec3 world) {
    vec3 d = world - lensCenter[i];
    return vec3(dot(lensToUnit[3 * i], d), dot(lensToUnit[3 * i + 1], d), dot(lensToUnit[3 * i + 2], d));
}

// `doi`: degree of interest there, which is the weight of a selection.
float lensWeightAt(int i, vec3 world, float doi) {
    float own = LENS_KIND(i) == LENS_SHAPE_SELECTION
                    ? doi : lensWeight(lensRadius(LENS_KIND(i), lensPlace(i, world)), lensEdge[i].x);
    return lensEdge[i].y > 0.5 ? 1.0 - own : own;
}

float lensWeightAt(int i, vec3 world) {
    return lensWeightAt(i, world, 0.0);
}
#endif

// Factors on opacity and saturation for a layer that belongs to lens `own` (-1: to none), where the degree of interest
// is `doi`.
vec2 lensAction(int own, vec3 world, float doi) {
    vec2 action = vec2(1.0);
#if LENS_ACTS
    for (int i = 0; i < LENSES; ++i) {
        float weight = lensWeightAt(i, world, doi);
        if (i == own) action = vec2(weight, 1.0);
        if (i > own) action *= vec2(mix(lensAct[i].y, lensAct[i].x, weight), mix(1.0, lensAct[i].z, weight));
    }
#endif
    return action;
}

vec2 lensAction(int own, vec3 world) {
    return lensAction(own, world, 0.0);
}

// The world position whose data magnifying lenses show at `world`.
vec3 lensBend(vec3 world) {
#if LENS_BENDS
    vec3 most = max(halfSize, abs(world));
    for (int i = LENSES - 1; i >= 0; --i) {
        if (LENS_BENDING(i) == 0) continue;
        vec3 u = lensPlace(i, world);
        float share = lensShare(lensRadius(LENS_KIND(i), u), lensEdge[i].z);
        world -= (1.0 - share) * (lensFromUnit[3 * i] * u.x + lensFromUnit[3 * i + 1] * u.y + lensFromUnit[3 * i + 2] * u.z);
    }
    world = clamp(world, -most, most);
#endif
    return world;
}

// The degree of interest after lenses that confine the brushes.
float lensConfine(float doi, vec3 world) {
#if LENS_FOCUS
    float most = 0.0, share = 0.0;
    for (int i = 0; i < LENSES; ++i) {
        share = max(share, lensEdge[i].w);
        most = max(most, lensEdge[i].w > 0.0 ? lensWeightAt(i, world) : 0.0);
    }
    doi = mix(doi, 1.0, share * (1.0 - most));
#endif
    return doi;
}
