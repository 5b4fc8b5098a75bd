// Iso-surfaces: intersection with the ray between two samples, and shading.
#if ISOS > 0

// Composites the iso-surfaces between samples k - 1 and k of one part, nearest first, interleaved with the events
// there. Afterwards `before` holds the values at sample k.
void showSurfaces(int k) {
    Met surfaces[ISOS];
    vec3 p = cellsAt(float(k));
    for (int n = 0; n < ISOS; ++n) {
        int i = ISO_LAYER(n), field = LAYER_FIELD(i);
        float value = layerMap[i].z;
        Reading a = readAt(field, p - ray.cellsPerSample), b = readAt(field, p);
        bool crossed = k > 0 && present(a) && present(b) && samePart(a, b) && (a.x >= value) != (b.x >= value);
        bool above = a.x >= value;
        before[i] = note(b, b.x);
        float lo = -1.0, hi = 0.0;
        for (int m = 0; m < (crossed ? bisections : 0); ++m) {
            float middle = 0.5 * (lo + hi);
            bool same = (readPart(field, b, p + middle * ray.cellsPerSample).x >= value) == above;
            lo = same ? middle : lo;
            hi = same ? hi : middle;
        }
        float offset = 0.5 * (lo + hi), at = float(k) + offset;
        vec3 q = p + offset * ray.cellsPerSample;
#if PARTS
        crossed = crossed && samePart(readAt(field, q), b);
#endif
        float doi = degreeOfInterest(q);
        crossed = crossed && clipShows(at);
        vec3 world = worldAt(at);
        vec2 lens = lensAction(LAYER_LENS(i), world, doi);
        float alpha = crossed ? min(layerMap[i].w * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x, 1.0) : 0.0;
        bool valued = FIELD_COVERAGE(field) == 1; // whether the value at q is of use
#if LOOKS
        valued = valued || (LAYER_LOOK(i) & LOOK_OUTLINE) != 0;
#endif
        float centre = valued ? reconstruct(field, q).x : 0.0;
        vec3 g = cellGradient(field, q, centre, crossed);
        vec3 albedo = focusColor(colorBy(i, q, layerColor[i]), doi, lens.y, LAYER_BRUSHED(i)), c = albedo, drawn = g;
#if LOOKS
        LookSample look;
        if (LAYER_LOOK(i) != 0) {
            drawn = lookGradient(i, field, readAt(field, q), q, centre, g, crossed);
            look = lookSample(i, field, q, centre, g, drawn, 1.0, world, distanceAt(at), ray.direction, doi, crossed);
#if (LOOKS & LOOK_OUTLINE)
            look.cut = cutDistance(world, look.normal, -ray.direction, halfSize, look.pixel);
#endif
            alpha = lookOpacity(i, alpha, look);
            c = lookAlbedo(i, albedo, look);
        }
#endif
        c = shade(c, shadingGradient(drawn), 1.0, world, -ray.direction);
#if LOOKS
        if (LAYER_LOOK(i) != 0) c = lookColor(i, albedo, c, look);
#endif
        surfaces[n] = Met(crossed ? at : kNowhere, vec4(c * alpha, alpha), focusInterest(doi, LAYER_BRUSHED(i)));
    }
    for (int n = 0; n < ISOS; ++n)
        for (int m = ISOS - 1; m > n; --m) order(surfaces[m - 1], surfaces[m]);
    for (int n = 0; n < ISOS; ++n) {
#if EVENTS > 0
        showEvents(min(surfaces[n].at, float(k)));
#endif
        show(surfaces[n]);
    }
}
#endif
