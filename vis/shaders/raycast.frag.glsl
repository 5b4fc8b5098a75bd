// The one ray loop: volume-like layers and slices of a scene, composited front to back in linear light. What happens
// along a ray is written down in vis/model/ray_setup.h; the reference ray caster does the same in double precision.
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

layout(location = 0) out vec4 outColor; // linear, premultiplied
layout(location = 1) out vec2 outPick; // distance along the ray of what a pixel shows, < 0: nothing; its interest

#ifdef REACH
layout(location = 2) out float outReach; // distance along the ray up to which anything was looked at; 0: nowhere
#endif

#define EVENTS (SLICES + GEOMETRY)

// Of the samples of an empty region the last ones that are taken all the same: where surfaces are looked for, and local
// maxima end, between samples, one; where parts of the ray are classified from end to end, one more.
#if HAS_SLABS
#define LAST_EMPTY 2
#elif ONLY_COMPOSITE
#define LAST_EMPTY 0
#else
#define LAST_EMPTY 1
#endif

// How many samples the one that is taken stands for.
#ifdef ADAPTIVE
#define TOGETHER together
#if EVENTS > 0
#define NEXT_EVENT nextEvent
#else
#define NEXT_EVENT 1e6
#endif
#else
#define TOGETHER 1
#endif

const float kOpaque = 0.995, kPickOpacity = 0.1, kFlatGradient = 0.005;
const float kNoPick = -2.0;

float interest = 0.0; // of what a pixel shows, times its opacity; for CONTEXT_BLUR

// Puts `top` with a degree of interest behind what has accumulated.
vec4 show(vec4 color, vec4 top, float doi) {
    interest += (1.0 - color.a) * top.a * doi;
    return under(color, top);
}

#include "lib/events.glsl"

#ifdef ADAPTIVE
// Samples from k on that one stands for, none of them behind the next event.
int samplesFrom(int k, vec3 p, float stepLength, int count, float event) {
    int most = min(count - k, int(ceil(min(event, 1e6))) - k);
    return max(min(samplesTogether(p, stepLength), most), 1);
}
#endif

#if LAYERS > 0
#include "lib/classify.glsl"
#if LOOKS
#include "lib/draw_look.glsl"
#include "lib/look_sample.glsl"
#endif
#endif

void main() {
    keepUniforms();
    vec2 ndc = gl_FragCoord.xy * ndcScale + ndcOffset;
    vec3 origin = rayOrigin + ndc.x * rayOriginX + ndc.y * rayOriginY;
    vec3 direction = normalize(rayDirection + ndc.x * rayDirectionX + ndc.y * rayDirectionY);
    vec2 inside = clipToBox(origin, direction, halfSize);
    inside.x = max(inside.x, rayBegin);
    inside = clipRay(inside, origin, direction);
    bool meets = inside.x < inside.y;
    float along = meets ? inside.y - inside.x : 0.0;
    int count = meets ? max(1, int(ceil(along * length(direction / worldCell) / stepVoxels - 1e-4))) : 0;
    float stepLength = along / float(max(count, 1));
    vec3 cellsPerSample = direction * stepLength * cellsPerWorld;
    // Sample k lies at inside.x + (k + phase) * stepLength.
    float phase = JITTER == 1 ? 0.5 + startJitter(uvec2(gl_FragCoord.xy), uint(passNumber)) : 0.5;
    vec3 first = toCells(origin + direction * inside.x) + phase * cellsPerSample;
    findHoles(origin, direction, inside.x, stepLength, phase);
#if SKIPPING
    beginBlocks(cellsPerSample);
#endif
    float lengths = stepLength * REFERENCE_LENGTHS;

    vec4 color = vec4(0.0);
    float pick = kNoPick;

#if EVENTS > 0
    findEvents(origin, direction, inside, stepLength, phase, meets, count);
    float passed = -1e8; // events up to here are in `color`
    float nextEvent = eventAt[0];
#endif

#if LAYERS > 0
    // What the projections have seen: best score and where, sums; a local maximum that is found has weight 1.
    float best[LAYERS], bestAt[LAYERS], sum[LAYERS], weight[LAYERS], factor[LAYERS];
    for (int i = 0; i < LAYERS; ++i) {
        best[i] = -1.0; bestAt[i] = 0.0; sum[i] = 0.0; weight[i] = 0.0; factor[i] = 0.0;
    }
    float before[LAYERS]; // iso: value at sample k - 1; slab: place at the front of sample k's part
    for (int i = 0; i < LAYERS; ++i) before[i] = kUnknown;
#if HAS_SLABS
    for (int i = 0; i < LAYERS; ++i)
        if (LAYER_LOOKUP(i) == LOOKUP_SLAB) {
            vec2 s = reconstruct(LAYER_FIELD(i), first - 0.5 * cellsPerSample);
            before[i] = present(s) ? s.x * layerMap[i].x + layerMap[i].y : kUnknown;
        }
#endif
#ifdef COUNT_SAMPLES
    int samples = 0;
#endif
    int k = 0;
    while (k < count && color.a < kOpaque) {
        bool hit = false;
        float previous[LAYERS]; // `before` at this sample; far below: absent or not known
        for (int i = 0; i < LAYERS; ++i) previous[i] = before[i];
        vec2 here[LAYERS];
#if HAS_SLABS
        float front[LAYERS]; // of slabs
#endif
#if !FLAT
        while (k < count) {
#endif
            vec3 p = first + float(k) * cellsPerSample;
#if SKIPPING
#if HAS_SLABS
            // From the front of this sample's part; the last empty one gives the next its front.
            int leap = emptySamples(p - 0.5 * cellsPerSample) - LAST_EMPTY;
#else
            int leap = emptySamples(p) - LAST_EMPTY;
#endif
            // And on with the sample behind: software GL would take one in any case.
            if (leap > 0) {
                k += leap;
                p = first + float(k) * cellsPerSample;
                for (int i = 0; i < LAYERS; ++i) previous[i] = kUnknown;
            }
#endif
#if CLIP_HOLES
            int hidden = clipLeap(float(k));
            if (hidden > 0) {
                k += hidden;
                for (int i = 0; i < LAYERS; ++i) previous[i] = kUnknown;
#if FLAT
                for (int i = 0; i < LAYERS; ++i) before[i] = kUnknown;
#endif
                continue;
            }
#endif
            bool within = k < count;
#if EVENTS > 0
            hit = float(k) >= nextEvent;
#endif
#ifdef COUNT_SAMPLES
            samples += LAYERS;
#endif
#ifdef ADAPTIVE
            int together = samplesFrom(k, p, stepLength, count, NEXT_EVENT);
            float at = float(k) + 0.5 * float(together - 1);
            p = first + at * cellsPerSample;
#else
            float at = float(k);
#endif
            vec3 seen = origin + direction * (inside.x + (at + phase) * stepLength);
            for (int i = 0; i < LAYERS; ++i) {
                vec2 s = reconstruct(LAYER_FIELD(i), LAYER_LOOKUP(i) == LOOKUP_SLAB ? p + 0.5 * cellsPerSample : p);
                vec2 lens = lensAction(LAYER_LENS(i), seen);
                bool is = present(s);
                here[i] = s;
                float x = s.x * layerMap[i].x + layerMap[i].y;
                if (LAYER_GRADIENT(i) == 1 && (FLAT == 0 || LAYER_STYLE(i) != COMPOSITE))
                    x = gradientPlace(i, cellGradient(LAYER_FIELD(i), p, s.x, is));
                if (LAYER_STYLE(i) == COMPOSITE) {
                    float share = 1.0, opacity = is && opaqueAt(i, x) ? 1.0 : 0.0;
#if HAS_SLABS
                    if (LAYER_LOOKUP(i) == LOOKUP_SLAB) {
                        front[i] = previous[i];
                        previous[i] = is ? x : kUnknown;
                        opacity = slabColor(i, front[i], previous[i], share).a;
                    }
#endif
#if HAS_LATTICE && !FLAT
                    if (LAYER_LOOKUP(i) == LOOKUP_LATTICE) opacity = latticeColor(i, p, share).a;
#endif
                    hit = hit || opacity * share * lens.x > 0.0;
                } else if (LAYER_STYLE(i) == ISO) {
                    hit = hit || (is && previous[i] > kUnknown && (s.x >= layerMap[i].z) != (previous[i] >= layerMap[i].z));
                    previous[i] = is ? s.x : kUnknown;
                } else {
                    is = is && within && clipShows(float(k));
                    float f = is ? focusOpacity(degreeOfInterest(p), LAYER_BRUSHED(i)) * lens.x : 0.0;
                    float place = clamp(x, 0.0, 1.0);
                    if (LAYER_STYLE(i) == AVERAGE) {
                        sum[i] += is ? f * x : 0.0;
                        weight[i] += f;
                        factor[i] += is ? 1.0 : 0.0;
                    } else if (LAYER_STYLE(i) == XRAY) {
                        float a = is ? correctedOpacity(transfer(i, x).a * f, lengths * layerMap[i].z) : 0.0;
                        sum[i] += (1.0 - sum[i]) * a;
                    } else {
                        float score = (LAYER_STYLE(i) == MINIMUM ? 1.0 - place : place) * f;
                        // A local maximum stands when the values fall again above the threshold.
                        if (LAYER_STYLE(i) == LOCAL_MAXIMUM)
                            weight[i] = best[i] >= layerMore[i].y && (!is || score < best[i]) ? 1.0 : weight[i];
                        bool better = is && score > best[i] && weight[i] == 0.0;
                        bestAt[i] = better ? float(k) : bestAt[i];
                        best[i] = better ? score : best[i];
                    }
                }
            }
            hit = hit && within;
#if FLAT
        hit = within;
#else
            if (hit) break;
            k += TOGETHER;
        }
#endif
        if (hit) {
#if !FLAT
            vec3 p = first + float(k) * cellsPerSample;
#ifdef ADAPTIVE
            int together = samplesFrom(k, p, stepLength, count, NEXT_EVENT);
            float at = float(k) + 0.5 * float(together - 1);
            vec3 middle = first + at * cellsPerSample;
#else
            float at = float(k);
            vec3 middle = p;
#endif
            for (int i = 0; i < LAYERS; ++i)
                if (LAYER_STYLE(i) == COMPOSITE) here[i] = reconstruct(LAYER_FIELD(i), middle);
#if HAS_SLABS
            for (int i = 0; i < LAYERS; ++i)
                if (LAYER_LOOKUP(i) == LOOKUP_SLAB) {
                    vec2 a = reconstruct(LAYER_FIELD(i), p - 0.5 * cellsPerSample);
                    vec2 b = reconstruct(LAYER_FIELD(i), p + 0.5 * cellsPerSample);
                    front[i] = present(a) ? a.x * layerMap[i].x + layerMap[i].y : kUnknown;
                    before[i] = present(b) ? b.x * layerMap[i].x + layerMap[i].y : kUnknown;
                }
#endif
#elif HAS_SLABS
            for (int i = 0; i < LAYERS; ++i)
                if (LAYER_LOOKUP(i) == LOOKUP_SLAB) before[i] = previous[i];
#endif
#if ISOS > 0
            // Where the surfaces are met after the last sample (in samples), and what is seen there; nearest first.
            float isoAt[ISOS];
            vec4 isoColor[ISOS];
            float isoInterest[ISOS];
            for (int n = 0; n < ISOS; ++n) {
                int i = ISO_LAYER(n), field = LAYER_FIELD(i);
                float value = layerMap[i].z;
                vec2 a = reconstruct(field, p - cellsPerSample), b = reconstruct(field, p);
                bool crossed = k > 0 && present(a) && present(b) && (a.x >= value) != (b.x >= value);
                bool above = a.x >= value;
                before[i] = present(b) ? b.x : kUnknown;
                float lo = -1.0, hi = 0.0;
                for (int m = 0; m < (crossed ? bisections : 0); ++m) {
                    float middle = 0.5 * (lo + hi);
                    bool same = (reconstruct(field, p + middle * cellsPerSample).x >= value) == above;
                    lo = same ? middle : lo;
                    hi = same ? hi : middle;
                }
                float at = 0.5 * (lo + hi);
                vec3 q = p + at * cellsPerSample;
                float doi = degreeOfInterest(q);
                crossed = crossed && clipShows(float(k) + at);
                vec3 world = origin + direction * (inside.x + (float(k) + phase + at) * stepLength);
                vec2 lens = lensAction(LAYER_LENS(i), world);
                float alpha = crossed ? min(layerMap[i].w * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x, 1.0) : 0.0;
                float centre = FIELD_COVERAGE(field) == 1 ? reconstruct(field, q).x : 0.0;
                vec3 g = cellGradient(field, q, centre, crossed);
                vec3 albedo = focusColor(layerColor[i], doi, lens.y, LAYER_BRUSHED(i)), c = albedo;
#if LOOKS
                LookSample look;
                if (LAYER_LOOK(i) != 0) {
                    look = lookSample(i, field, q, g, 1.0, world, inside.x + (float(k) + phase + at) * stepLength,
                                      direction, doi, crossed);
                    alpha = lookOpacity(i, alpha, look);
                    c = lookAlbedo(i, albedo, look);
                }
#endif
                c = shade(c, shadingGradient(g), 1.0, world, -direction);
#if LOOKS
                if (LAYER_LOOK(i) != 0) c = lookColor(i, albedo, c, look);
#endif
                isoAt[n] = crossed ? float(k) + at : 1e9;
                isoColor[n] = vec4(c * alpha, alpha);
                isoInterest[n] = focusInterest(doi, LAYER_BRUSHED(i));
            }
            for (int n = 0; n < ISOS; ++n)
                for (int m = ISOS - 1; m > n; --m)
                    if (isoAt[m] < isoAt[m - 1]) {
                        float at = isoAt[m]; isoAt[m] = isoAt[m - 1]; isoAt[m - 1] = at;
                        vec4 c = isoColor[m]; isoColor[m] = isoColor[m - 1]; isoColor[m - 1] = c;
                        float doi = isoInterest[m]; isoInterest[m] = isoInterest[m - 1]; isoInterest[m - 1] = doi;
                    }
            for (int n = 0; n < ISOS; ++n) {
#if EVENTS > 0
                float until = min(isoAt[n], float(k));
                for (int j = 0; j < EVENTS; ++j)
                    if (eventAt[j] > passed && eventAt[j] <= until) {
                        color = show(color, eventColor[j], eventInterest[j]);
                        if (pick <= kNoPick && color.a > kPickOpacity) pick = eventAt[j];
                    }
                passed = max(passed, until);
#endif
                color = show(color, isoColor[n], isoInterest[n]);
                if (pick <= kNoPick && color.a > kPickOpacity) pick = min(isoAt[n], float(k));
            }
#endif
#if EVENTS > 0
            for (int i = 0; i < EVENTS; ++i)
                if (eventAt[i] > passed && eventAt[i] <= float(k)) {
                    color = show(color, eventColor[i], eventInterest[i]);
                    if (pick <= kNoPick && color.a > kPickOpacity) pick = eventAt[i];
                }
            passed = float(k);
            nextEvent = 1e9;
            for (int i = EVENTS - 1; i >= 0; --i)
                if (eventAt[i] > passed) nextEvent = eventAt[i];
#endif
#if HAS_COMPOSITE
#if !FLAT
            p = middle;
#endif
            for (int i = 0; i < LAYERS; ++i) {
                if (LAYER_STYLE(i) != COMPOSITE) continue;
                vec2 s = here[i];
                float share = present(s) ? 1.0 : 0.0;
                bool byGradient = LAYER_GRADIENT(i) == 1 || LAYER_LOOKUP(i) == LOOKUP_PLANE;
                float x = s.x * layerMap[i].x + layerMap[i].y;
                vec3 g = vec3(0.0);
                if (byGradient) g = cellGradient(LAYER_FIELD(i), p, s.x, share > 0.0 && (LAYER_GRADIENT(i) == 1 || opaqueAt(i, x)));
                if (LAYER_GRADIENT(i) == 1) x = gradientPlace(i, g);
                vec4 c;
#if HAS_PLANES
                if (LAYER_LOOKUP(i) == LOOKUP_PLANE) c = planeAt(LAYER_PLANE(i), vec2(x, gradientPlace(i, g))); else
#endif
#if HAS_SLABS
                if (LAYER_LOOKUP(i) == LOOKUP_SLAB) c = slabColor(i, front[i], before[i], share); else
#endif
#if HAS_LATTICE
                if (LAYER_LOOKUP(i) == LOOKUP_LATTICE) c = latticeColor(i, p, share); else
#endif
                c = transfer(i, x);
                float doi = degreeOfInterest(p);
                float t = inside.x + (at + phase) * stepLength;
                vec3 world = origin + direction * t;
                vec2 lens = lensAction(LAYER_LENS(i), world);
                c.rgb = focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i));
                float opacity = c.a * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x;
                float thickness = lengths * layerMap[i].z * share * clipCoverage(float(k)) * float(TOGETHER);
                float alpha = correctedOpacity(opacity, thickness);
                bool surface = LAYER_SHADED(i) == 1 || LAYER_LOOK(i) != 0;
                if (surface && !byGradient) g = cellGradient(LAYER_FIELD(i), p, present(s) ? s.x : kUnknown, alpha > 0.0);
                float fade = min(1.0, length(g) * abs(layerMap[i].x) / kFlatGradient);
                vec3 albedo = c.rgb;
#if LOOKS
                LookSample look;
                if (LAYER_LOOK(i) != 0) {
                    look = lookSample(i, LAYER_FIELD(i), p, g, fade, world, t, direction, doi, alpha > 0.0);
                    alpha = correctedOpacity(lookOpacity(i, opacity, look), thickness);
                    c.rgb = lookAlbedo(i, albedo, look);
                }
#endif
                c.rgb = LAYER_SHADED(i) == 1 ? shade(c.rgb, shadingGradient(g), fade, world, -direction)
                                             : shadeFlat(c.rgb, world);
#if LOOKS
                if (LAYER_LOOK(i) != 0) c.rgb = lookColor(i, albedo, c.rgb, look);
#endif
                color = show(color, vec4(c.rgb * alpha, alpha), focusInterest(doi, LAYER_BRUSHED(i)));
            }
            if (pick <= kNoPick && color.a > kPickOpacity) pick = at;
#endif
            k += TOGETHER;
        }
    }
#endif

#if EVENTS > 0
    if (color.a < kOpaque)
        for (int i = 0; i < EVENTS; ++i)
            if (eventAt[i] > passed && eventAt[i] < 1e8) {
                color = show(color, eventColor[i], eventInterest[i]);
                if (pick <= kNoPick && color.a > kPickOpacity) pick = eventAt[i];
            }
#endif
#ifdef REACH
    // Projections lie behind what is opaque and go no further.
#if LAYERS > 0
    float ended = float(min(k, count));
#else
    float ended = float(count);
#endif
    outReach = !meets ? 0.0 : color.a < kOpaque ? inside.y : inside.x + (ended + phase) * stepLength;
#endif
#if HAS_PROJECTION
    for (int i = 0; i < LAYERS; ++i) {
        if (LAYER_STYLE(i) == COMPOSITE || LAYER_STYLE(i) == ISO) continue;
        vec4 c;
        float alpha, at = 0.5 * float(count), doi = 1.0; // sums belong to no place
        if (LAYER_STYLE(i) == XRAY) {
            alpha = sum[i];
            c = transfer(i, alpha);
        } else if (LAYER_STYLE(i) == AVERAGE) {
            c = transfer(i, sum[i] / max(weight[i], 1e-6));
            alpha = weight[i] > 0.0 ? min(min(1.0, layerMap[i].z * c.a) * (weight[i] / max(factor[i], 1.0)), 1.0) : 0.0;
        } else {
            at = bestAt[i];
            vec3 p = first + at * cellsPerSample;
            vec2 s = reconstruct(LAYER_FIELD(i), p);
            float x = s.x * layerMap[i].x + layerMap[i].y;
            if (LAYER_GRADIENT(i) == 1) x = gradientPlace(i, cellGradient(LAYER_FIELD(i), p, s.x, best[i] >= 0.0));
            doi = degreeOfInterest(p);
            c = transfer(i, x);
            vec2 lens = lensAction(LAYER_LENS(i), origin + direction * (inside.x + (at + phase) * stepLength));
            c.rgb = focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i));
            alpha = best[i] >= 0.0 ? min(min(1.0, layerMap[i].z * c.a) * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x, 1.0) : 0.0;
        }
        color = show(color, vec4(c.rgb * alpha, alpha), focusInterest(doi, LAYER_BRUSHED(i)));
        if (pick <= kNoPick && color.a > kPickOpacity) pick = at;
    }
#endif
    outColor = meets ? color : vec4(0.0);
#if defined(COUNT_SAMPLES) && LAYERS > 0
    outColor = vec4(float(samples), 0.0, 0.0, 1.0);
#endif
    outPick = vec2(pick <= kNoPick ? -1e9 : inside.x + (pick + phase) * stepLength, 0.0);
#if CONTEXT_BLUR
    outPick.y = meets && color.a > 0.0 ? interest / color.a : 0.0;
#endif
}
