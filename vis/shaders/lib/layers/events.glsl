// Intersections of the ray with slices and rasterised surfaces, sorted by distance.
#include "formulas/colors.glsl"
#include "lib/layers/strokes.glsl"

#define EVENTS (SLICES + GEOMETRY)

#if EVENTS > 0
Met events[EVENTS];
float passed = -1e8;        // events up to here are composited
float nextEvent = kNowhere; // the next event after that

// Position in samples of distance t.
float sampleAt(float t) {
    return (t - ray.inside.x) / ray.stepLength - ray.phase;
}

// Collects and sorts the intersections. The ray is shortened to end at an opaque surface.
void findEvents() {
#if SLICES > 0
    for (int i = 0; i < SLICES; ++i) {
        float slope = dot(slicePlane[i].xyz, ray.direction);
        float t = (slicePlane[i].w - dot(slicePlane[i].xyz, ray.origin)) / (abs(slope) < 1e-9 ? 1e-9 : slope);
        vec3 world = ray.origin + ray.direction * t;
        vec3 p = toCells(clamp(world, -halfSize, halfSize));
        vec2 s = reconstruct(SLICE_FIELD(i), p);
        float x = s.x * sliceMap[i].x + sliceMap[i].y;
        float doi = degreeOfInterest(p);
        vec3 c = transfer(LAYERS + i, x).rgb;
        float level = x * (sliceMap[i].z + 1.0), there = present(s) ? 1.0 : 0.0;
        vec2 changes = abs(vec2(dFdx(level), dFdy(level))), ends = vec2(dFdx(there), dFdy(there));
        float width = (ends.x == 0.0 ? changes.x : 0.0) + (ends.y == 0.0 ? changes.y : 0.0);
#if PARTS
        // Use the gradient within the part, so that a jump between parts draws no contour line.
        vec3 across = dFdx(world), up = dFdy(world);
        if (FIELD_PARTS(SLICE_FIELD(i)) > 1) {
            vec3 g = cellGradient(SLICE_FIELD(i), p, s.x, sliceMap[i].z > 0.5) / worldCell;
            width = (abs(dot(g, across)) + abs(dot(g, up))) * abs(sliceMap[i].x) * (sliceMap[i].z + 1.0);
        }
#endif
        bool drawn = present(s);
#if STROKES
        if (SLICE_STROKES(i) == 1) {
            vec2 strokes = sliceStrokes(i, world);
            bool grey = strokeLook[i].y > 0.5;
            c = withStrokes(grey ? vec3(kStrokeGrey) : c, strokes.x, strokeLook[i].x);
            drawn = drawn && (!grey || strokes.y >= 0.5);
        }
#endif
        if (sliceMap[i].z > 0.5) c = withContours(c, level, width, int(sliceMap[i].z));
        float tolerance = 1e-5;
        bool seen = ray.meets && abs(slope) > 1e-6 && t > ray.inside.x - tolerance && t < ray.inside.y + tolerance &&
                    drawn;
        float at = sampleAt(t);
        events[i].at = seen && clipShows(at) ? at : kNowhere;
        vec2 lens = lensAction(SLICE_LENS(i), world, doi);
        float alpha = min(sliceMap[i].w * focusOpacity(doi, SLICE_BRUSHED(i)) * lens.x, 1.0);
        events[i].color = vec4(focusColor(c, doi, lens.y, SLICE_BRUSHED(i)) * alpha, alpha);
        events[i].interest = focusInterest(doi, SLICE_BRUSHED(i));
    }
#endif
#if GEOMETRY > 0
    for (int i = 0; i < GEOMETRY; ++i) {
        ivec3 texel = ivec3(gl_FragCoord.xy, i);
        vec2 found = texelFetch(geometryDistance, texel, 0).rg;
        float t = found.x;
        bool seen = ray.meets && t < 1e8;
        Met met = Met(seen ? sampleAt(t) : kNowhere, seen ? texelFetch(geometryColor, texel, 0) : vec4(0.0), 1.0);
#if BRUSH_TESTS > 0
        // Brushes are applied here, after lighting, since the rasteriser does not know them.
        int effect = int(found.y + 0.5);
        float doi = degreeOfInterest(toCells(ray.origin + ray.direction * min(t, 1e3)));
        vec3 own = focusColor(met.color.rgb / max(met.color.a, 1e-6), doi, 1.0, effect);
        float alpha = met.color.a * focusOpacity(doi, effect);
        met.color = vec4(own * alpha, alpha);
        met.interest = focusInterest(doi, effect);
#endif
        events[SLICES + i] = met;
        // The ray ends at an opaque surface.
        if (met.color.a >= kOpaque) ray.count = clamp(int(floor(min(met.at, 1e8))) + 1, 0, ray.count);
    }
#endif
    for (int i = 0; i < EVENTS; ++i)
        for (int j = EVENTS - 1; j > i; --j) order(events[j - 1], events[j]);
    nextEvent = events[0].at;
}

// Composites pending events up to `until` (in samples).
void showEvents(float until) {
    for (int i = 0; i < EVENTS; ++i)
        if (events[i].at > passed && events[i].at <= until) show(events[i]);
    passed = max(passed, until);
}

void findNextEvent() {
    nextEvent = kNowhere;
    for (int i = EVENTS - 1; i >= 0; --i)
        if (events[i].at > passed) nextEvent = events[i].at;
}
#endif
