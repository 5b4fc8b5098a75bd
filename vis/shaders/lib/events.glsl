// Where slices and rasterised surfaces are met along a ray (in samples: sample k at k), and what is seen there; nearest
// first.
#if EVENTS > 0
float eventAt[EVENTS];
vec4 eventColor[EVENTS];
float eventInterest[EVENTS];

// `count`: of the ray's samples; it ends behind what is opaque.
void findEvents(vec3 origin, vec3 direction, vec2 inside, float stepLength, float phase, bool meets, inout int count) {
#if SLICES > 0
    for (int i = 0; i < SLICES; ++i) {
        float slope = dot(slicePlane[i].xyz, direction);
        float t = (slicePlane[i].w - dot(slicePlane[i].xyz, origin)) / (abs(slope) < 1e-9 ? 1e-9 : slope);
        vec3 world = origin + direction * t;
        vec3 p = toCells(clamp(world, -halfSize, halfSize));
        vec2 s = reconstruct(SLICE_FIELD(i), p);
        float x = s.x * sliceMap[i].x + sliceMap[i].y;
        float doi = degreeOfInterest(p);
        vec3 c = transfer(LAYERS + i, x).rgb;
        float level = x * (sliceMap[i].z + 1.0), width = fwidth(level);
        if (sliceMap[i].z > 0.5 && width > 0.0) {
            // Contours at level = 1, 2, ..., n; a line 1.4 pixels wide, dark on light colours and light on dark ones.
            float away = abs(level - clamp(floor(level + 0.5), 1.0, sliceMap[i].z)) / width;
            c = mix(c, vec3(luminance(c) > 0.18 ? 0.0 : 1.0), 0.75 * clamp(1.2 - away, 0.0, 1.0) / max(1.0, width * 2.0));
        }
        float tolerance = 1e-5;
        bool seen = meets && abs(slope) > 1e-6 && t > inside.x - tolerance && t < inside.y + tolerance && present(s);
        float at = (t - inside.x) / stepLength - phase;
        eventAt[i] = seen && clipShows(at) ? at : 1e9;
        vec2 lens = lensAction(SLICE_LENS(i), world);
        float alpha = min(sliceMap[i].w * focusOpacity(doi, SLICE_BRUSHED(i)) * lens.x, 1.0);
        eventColor[i] = vec4(focusColor(c, doi, lens.y, SLICE_BRUSHED(i)) * alpha, alpha);
        eventInterest[i] = focusInterest(doi, SLICE_BRUSHED(i));
    }
#endif
#if GEOMETRY > 0
    for (int i = 0; i < GEOMETRY; ++i) {
        ivec3 texel = ivec3(gl_FragCoord.xy, i);
        vec2 found = texelFetch(geometryDistance, texel, 0).rg;
        float t = found.x;
        bool seen = meets && t < 1e8;
        eventAt[SLICES + i] = seen ? (t - inside.x) / stepLength - phase : 1e9;
        vec4 c = seen ? texelFetch(geometryColor, texel, 0) : vec4(0.0);
        eventInterest[SLICES + i] = 1.0;
#if BRUSH_TESTS > 0
        // Brushes act on what was lit: the rasteriser knows nothing of them.
        int effect = int(found.y + 0.5);
        float doi = degreeOfInterest(toCells(origin + direction * min(t, 1e3)));
        vec3 own = focusColor(c.rgb / max(c.a, 1e-6), doi, 1.0, effect);
        float alpha = c.a * focusOpacity(doi, effect);
        c = vec4(own * alpha, alpha);
        eventInterest[SLICES + i] = focusInterest(doi, effect);
#endif
        eventColor[SLICES + i] = c;
        // Nothing behind what is opaque: the ray ends there.
        if (eventColor[SLICES + i].a >= kOpaque)
            count = clamp(int(floor(min(eventAt[SLICES + i], 1e8))) + 1, 0, count);
    }
#endif
    for (int i = 0; i < EVENTS; ++i)
        for (int j = EVENTS - 1; j > i; --j)
            if (eventAt[j] < eventAt[j - 1]) {
                float at = eventAt[j]; eventAt[j] = eventAt[j - 1]; eventAt[j - 1] = at;
                vec4 c = eventColor[j]; eventColor[j] = eventColor[j - 1]; eventColor[j - 1] = c;
                float doi = eventInterest[j]; eventInterest[j] = eventInterest[j - 1]; eventInterest[j - 1] = doi;
            }
}
#endif
