// The one ray loop: volume-like layers and slices of a scene, composited front to back in linear light. What happens
// along a ray is written down in vis/optics/ray_setup.h; the reference ray caster does the same in double precision.
//
// March until hit, then shade: the inner loop only advances until something contributes, so that software GL, which
// has no branches, shades all lanes of a group at once. What leaves the inner loop is the sample's number alone; its
// values are taken anew (Mesa 22.3 miscompiles values that leave divergent nested loops). Where shading is cheap (FLAT)
// there is no inner loop.
#include "lib/bindings.glsl"
#include "lib/kept.glsl"
#include "lib/tables.glsl"
#include "lib/color.glsl"
#include "lib/clipping.glsl"
#include "lib/jitter.glsl"
#include "lib/ray.glsl"
#include <slot:shade>
#include "lib/shade.glsl"
#include <slot:fetch>
#include <slot:reconstruct>
#include "lib/gradient.glsl"
#include "lib/doi.glsl"
#include <slot:skip>
#include "lib/samples.glsl"
#include "lib/shown.glsl"

layout(location = 0) out vec4 outColor; // linear, premultiplied
layout(location = 1) out vec2 outPick; // distance along the ray of what a pixel shows, < 0: nothing; its interest

#ifdef REACH
layout(location = 2) out float outReach; // distance along the ray up to which anything was looked at; 0: nowhere
#endif

// Of the samples of an empty region the last ones that are taken all the same: where surfaces are looked for, and local
// maxima end, between samples, one; where parts of the ray are classified from end to end, one more.
#if HAS_SLABS
#define LAST_EMPTY 2
#elif ONLY_COMPOSITE
#define LAST_EMPTY 0
#else
#define LAST_EMPTY 1
#endif

const float kOpaque = 0.995, kFlatGradient = 0.005;

#include "lib/events.glsl"

// How many samples the one that is taken at k stands for, none of them behind the next event.
int samplesFrom(int k) {
#ifdef ADAPTIVE
    int most = ray.count - k;
#if EVENTS > 0
    most = min(most, int(ceil(min(nextEvent, 1e6))) - k);
#endif
    return max(min(samplesTogether(cellsAt(float(k)), ray.stepLength), most), 1);
#else
    return 1;
#endif
}

#if LAYERS > 0
#ifdef COUNT_SAMPLES
int samples = 0;
#endif

// Of each layer what is known at the sample under way.
#include "lib/classify.glsl"
#include "lib/color_by.glsl"
vec2 here[LAYERS];   // composite: value
Noted before[LAYERS]; // iso: value at sample k - 1; slab: place at the front of sample k's part
#if HAS_SLABS
Noted front[LAYERS];  // slab: the same of a sample that hits; `before` is then its back
#endif

#if LOOKS
#include "lib/draw_look.glsl"
#include "lib/look_sample.glsl"
#endif
#include "lib/iso_surfaces.glsl"
#include "lib/composite.glsl"
#include "lib/projections.glsl"

// Takes samples in until one contributes, and shows it, to the end of the ray or until nothing behind is seen. Returns
// the sample it ends at.
int march() {
    for (int i = 0; i < LAYERS; ++i) before[i] = kNothingNoted;
#if HAS_SLABS
    for (int i = 0; i < LAYERS; ++i)
        if (LAYER_LOOKUP(i) == LOOKUP_SLAB) before[i] = slabEnd(i, cellsAt(-0.5));
#endif
    int k = 0;
    while (k < ray.count && color.a < kOpaque) {
        bool hit = false;
        Noted previous[LAYERS]; // `before` at this sample; far below: absent or not known
        for (int i = 0; i < LAYERS; ++i) previous[i] = before[i];
#if !FLAT
        while (k < ray.count) {
#endif
            vec3 p = cellsAt(float(k));
#if SKIPPING
#if HAS_SLABS
            // From the front of this sample's part; the last empty one gives the next its front.
            int leap = emptySamples(p - 0.5 * ray.cellsPerSample) - LAST_EMPTY;
#else
            int leap = emptySamples(p) - LAST_EMPTY;
#endif
            // And on with the sample behind: software GL would take one in any case.
            if (leap > 0) {
                k += leap;
                p = cellsAt(float(k));
                for (int i = 0; i < LAYERS; ++i) previous[i] = kNothingNoted;
            }
#endif
#if CLIP_HOLES
            int hidden = clipLeap(float(k));
            if (hidden > 0) {
                k += hidden;
                for (int i = 0; i < LAYERS; ++i) previous[i] = kNothingNoted;
#if FLAT
                for (int i = 0; i < LAYERS; ++i) before[i] = kNothingNoted;
#endif
                continue;
            }
#endif
            bool within = k < ray.count;
#if EVENTS > 0
            hit = float(k) >= nextEvent;
#endif
#ifdef COUNT_SAMPLES
            samples += LAYERS;
#endif
            int together = samplesFrom(k);
            float at = float(k) + 0.5 * float(together - 1);
            p = cellsAt(at);
            vec3 seen = worldAt(at);
            for (int i = 0; i < LAYERS; ++i) {
                Reading s = readAt(LAYER_FIELD(i), LAYER_LOOKUP(i) == LOOKUP_SLAB ? p + 0.5 * ray.cellsPerSample : p);
                vec2 lens = lensAction(LAYER_LENS(i), seen);
                bool is = present(s);
                here[i] = s.xy;
                float x = s.x * layerMap[i].x + layerMap[i].y;
                if (LAYER_GRADIENT(i) == 1 && (FLAT == 0 || LAYER_STYLE(i) != STYLE_COMPOSITE))
                    x = gradientPlace(i, cellGradient(LAYER_FIELD(i), p, s.x, is));
                if (LAYER_STYLE(i) == STYLE_COMPOSITE) {
                    float share = 1.0, opacity = is && opaqueAt(i, x) ? 1.0 : 0.0;
#if HAS_SLABS
                    if (LAYER_LOOKUP(i) == LOOKUP_SLAB) {
                        front[i] = previous[i];
                        previous[i] = note(s, x);
                        opacity = slabColor(i, front[i], previous[i], share).a;
                    }
#endif
#if HAS_LATTICE && !FLAT
                    if (LAYER_LOOKUP(i) == LOOKUP_LATTICE) opacity = latticeColor(i, p, share).a;
#endif
                    hit = hit || opacity * share * lens.x > 0.0;
                } else if (LAYER_STYLE(i) == STYLE_ISO) {
                    float value = layerMap[i].z;
                    float last = notedValue(previous[i]);
                    hit = hit || (is && last > kUnknown && joined(previous[i], note(s, s.x)) &&
                                  (s.x >= value) != (last >= value));
                    previous[i] = note(s, s.x);
                } else {
#if HAS_PROJECTION
                    project(i, k, p, x, lens.x, is && within && clipShows(float(k)));
#endif
                }
            }
#if FLAT
            hit = within;
#else
            hit = hit && within;
            if (hit) break;
            k += together;
        }
#endif
        if (hit) {
            int together = samplesFrom(k);
            float at = float(k) + 0.5 * float(together - 1);
#if !FLAT
            for (int i = 0; i < LAYERS; ++i)
                if (LAYER_STYLE(i) == STYLE_COMPOSITE) here[i] = reconstruct(LAYER_FIELD(i), cellsAt(at));
#endif
#if HAS_SLABS
            for (int i = 0; i < LAYERS; ++i)
                if (LAYER_LOOKUP(i) == LOOKUP_SLAB) {
#if FLAT
                    before[i] = previous[i];
#else
                    front[i] = slabEnd(i, cellsAt(float(k) - 0.5));
                    before[i] = slabEnd(i, cellsAt(float(k) + 0.5));
#endif
                }
#endif
#if ISOS > 0
            showSurfaces(k);
#endif
#if EVENTS > 0
            showEvents(float(k));
            findNextEvent();
#endif
#if HAS_COMPOSITE
            showComposites(k, at, together);
#endif
            k += together;
        }
    }
    return k;
}
#endif

void main() {
    keepUniforms();
    beginRay();
#if SKIPPING
    beginBlocks(ray.cellsPerSample);
#endif
#if EVENTS > 0
    findEvents();
#endif
    int ended = ray.count;
#if LAYERS > 0
#if HAS_PROJECTION
    beginProjections();
#endif
    ended = min(march(), ray.count);
#endif
#if EVENTS > 0
    if (color.a < kOpaque) showEvents(kNowhere / 2.0);
#endif
#ifdef REACH
    // Projections lie behind what is opaque and go no further.
    outReach = !ray.meets ? 0.0 : color.a < kOpaque ? ray.inside.y : distanceAt(float(ended));
#endif
#if HAS_PROJECTION
    showProjections();
#endif
    outColor = ray.meets ? color : vec4(0.0);
#if defined(COUNT_SAMPLES) && LAYERS > 0
    outColor = vec4(float(samples), 0.0, 0.0, 1.0);
#endif
    outPick = vec2(pick <= kNoPick ? -1e9 : distanceAt(pick), 0.0);
#if CONTEXT_BLUR
    outPick.y = ray.meets && color.a > 0.0 ? interest / color.a : 0.0;
#endif
}
