// The ray loop for all ray layers and slices of a scene, composited front to back in linear light. The algorithm is
// specified in vis/optics/ray_setup.h; the reference ray caster implements it in double precision.
//
// March until hit, then shade: the inner loop only advances until a sample contributes, so that software GL, which
// executes both sides of every branch, shades all lanes of a group at once. Only the sample number leaves the inner
// loop; values are sampled again, since Mesa 22.3 miscompiles values that leave divergent nested loops. If shading is
// cheap (FLAT), there is no inner loop.
#include "lib/bindings/bindings.glsl"
#include "lib/bindings/kept.glsl"
#include "lib/bindings/tables.glsl"
#include "lib/layers/color.glsl"
#include "lib/sampling/clipping.glsl"
#include "lib/sampling/jitter.glsl"
#include "lib/sampling/ray.glsl"
#include <slot:shade>
#include "lib/shading/shade.glsl"
#include <slot:fetch>
#include <slot:reconstruct>
#include "lib/sampling/gradient.glsl"
#include "lib/layers/doi.glsl"
#include <slot:skip>
#include "lib/sampling/samples.glsl"
#include "lib/layers/shown.glsl"

layout(location = 0) out vec4 outColor; // linear, premultiplied
layout(location = 1) out vec2 outPick; // distance along the ray of the picked sample, < 0: none; degree of interest

#ifdef REACH
layout(location = 2) out float outTermination; // termination depth along the ray; 0: the ray misses the box
#endif

// Number of samples at the end of an empty region that are still taken: 1 if iso-surfaces and local maxima are detected
// between consecutive samples, 2 if segments are classified from end to end.
#if HAS_SLABS
#define LAST_EMPTY 2
#elif ONLY_COMPOSITE
#define LAST_EMPTY 0
#else
#define LAST_EMPTY 1
#endif

const float kOpaque = 0.995, kFlatGradient = 0.005;

#include "lib/layers/events.glsl"

// Number of samples that the one taken at k represents (adaptive sampling), limited by the next event.
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

// State of each layer at the current sample.
#include "lib/layers/classify.glsl"
#include "lib/layers/color_by.glsl"
vec2 here[LAYERS];   // composite: value
Noted before[LAYERS]; // iso: value at sample k - 1; slab: position at the front of sample k's segment
#if HAS_SLABS
Noted front[LAYERS];  // slab: the same for a contributing sample; `before` is then its back
#endif

#if LOOKS
#include "lib/shading/draw_look.glsl"
#include "lib/shading/look_sample.glsl"
#endif
#include "lib/layers/iso_surfaces.glsl"
#include "lib/layers/composite.glsl"
#include "lib/layers/projections.glsl"

// Advances to the next contributing samples and composites them, until the ray ends or is opaque (early ray
// termination). Returns the sample at which it ends.
int march() {
    for (int i = 0; i < LAYERS; ++i) before[i] = kNothingNoted;
#if HAS_SLABS
    for (int i = 0; i < LAYERS; ++i)
        if (LAYER_LOOKUP(i) == LOOKUP_SLAB) before[i] = slabEnd(i, cellsAt(-0.5));
#endif
    int k = 0;
    while (k < ray.count && color.a < kOpaque) {
        bool hit = false;
        Noted previous[LAYERS]; // `before` at this sample; kNothingNoted: absent or unknown
        for (int i = 0; i < LAYERS; ++i) previous[i] = before[i];
#if !FLAT
        while (k < ray.count) {
#endif
            vec3 p = cellsAt(float(k));
#if SKIPPING
#if HAS_SLABS
            // Skip from the front of this sample's segment; the last empty sample supplies the front of the next
            // segment.
            int leap = emptySamples(p - 0.5 * ray.cellsPerSample) - LAST_EMPTY;
#else
            int leap = emptySamples(p) - LAST_EMPTY;
#endif
            // Take the next sample in the same iteration: software GL would execute the rest of it anyway.
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
                vec2 lens = lensAction(LAYER_LENS(i), seen, LENS_SELECTS == 1 ? degreeOfInterest(p) : 0.0);
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
    // Projections are composited behind everything and do not extend the termination depth.
    outTermination = !ray.meets ? 0.0 : color.a < kOpaque ? ray.inside.y : distanceAt(float(ended));
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
