// The scene's clips (lib/bindings/bindings.glsl) along a ray. The intervals of holes are in units of samples.
#include "lib/sampling/clip.glsl"

// Restricts an interval to the clips that keep their inside.
vec2 clipRay(vec2 inside, vec3 origin, vec3 direction) {
#if CLIPS > 0
    for (int i = 0; i < CLIPS; ++i) {
        if (CLIP_HOLE(i) == 1) continue;
        vec2 own = clipInside(CLIP_KIND(i), clipCenter[i], clipAxis[i], clipHalf[i], origin, direction);
        inside = vec2(max(inside.x, own.x), min(inside.y, own.y));
    }
#endif
    return inside;
}

// Whether a world point is inside all of these.
bool clipKept(vec3 world) {
    bool kept = true;
#if CLIPS > 0
    for (int i = 0; i < CLIPS; ++i) {
        vec3 d = world - clipCenter[i];
        float along = dot(d, clipAxis[i]);
        bool within = CLIP_KIND(i) == 0   ? along <= 0.0
                      : CLIP_KIND(i) == 1 ? all(lessThanEqual(abs(d), clipHalf[i]))
                      : CLIP_KIND(i) == 2 ? length(d) <= clipHalf[i].x
                                          : length(d - along * clipAxis[i]) <= clipHalf[i].x && abs(along) <= clipHalf[i].y;
        kept = kept && within != (CLIP_HOLE(i) == 1);
    }
#endif
    return kept;
}

#if CLIP_HOLES
vec2 clipHoles[CLIPS]; // of this ray, in samples; empty if x >= y
#endif

// `enter` and `step` in world units; sample k lies at enter + (k + phase) * step.
void findHoles(vec3 origin, vec3 direction, float enter, float step, float phase) {
#if CLIP_HOLES
    for (int i = 0; i < CLIPS; ++i) {
        vec2 own = clipInside(CLIP_KIND(i), clipCenter[i], clipAxis[i], clipHalf[i], origin, direction);
        clipHoles[i] = CLIP_HOLE(i) == 1 ? clamp((own - enter) / max(step, 1e-12) - phase, -1e6, 1e6) : vec2(1e6, -1e6);
    }
#endif
}

// Fraction of sample k's segment that lies in no hole.
float clipCoverage(float k) {
    float left = 1.0;
#if CLIP_HOLES
    for (int i = 0; i < CLIPS; ++i)
        left -= max(0.0, min(clipHoles[i].y, k + 0.5) - max(clipHoles[i].x, k - 0.5));
#endif
    return max(left, 0.0);
}

// Whether a position on the ray, in samples, lies in no hole.
bool clipShows(float k) {
    bool shows = true;
#if CLIP_HOLES
    for (int i = 0; i < CLIPS; ++i) shows = shows && !(k > clipHoles[i].x && k < clipHoles[i].y);
#endif
    return shows;
}

// Number of samples from k on that can be skipped: they and the sample after them lie entirely in one hole.
int clipLeap(float k) {
    float leap = 0.0;
#if CLIP_HOLES
    for (int i = 0; i < CLIPS; ++i)
        if (k - 0.5 > clipHoles[i].x) leap = max(leap, floor(clipHoles[i].y - 0.5 - k));
#endif
    return int(leap);
}
