// Composite layers: colour and opacity of a ray segment.
#if HAS_COMPOSITE

// Composites the sample at `at`, whose values are `here`. It represents `together` samples, the first of which is k.
void showComposites(int k, float at, int together) {
    vec3 p = cellsAt(at), world = worldAt(at);
    for (int i = 0; i < LAYERS; ++i) {
        if (LAYER_STYLE(i) != STYLE_COMPOSITE) continue;
        vec2 s = here[i];
        float share = present(s) ? 1.0 : 0.0;
        bool byGradient = LAYER_GRADIENT(i) == 1 || LAYER_LOOKUP(i) == LOOKUP_PLANE;
        float x = s.x * layerMap[i].x + layerMap[i].y;
        vec3 g = vec3(0.0);
        if (byGradient)
            g = cellGradient(LAYER_FIELD(i), p, s.x, share > 0.0 && (LAYER_GRADIENT(i) == 1 || opaqueAt(i, x)));
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
        c.rgb = colorBy(i, p, c.rgb);
        float doi = degreeOfInterest(p);
        vec2 lens = lensAction(LAYER_LENS(i), world, doi);
        c.rgb = focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i));
        float opacity = c.a * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x;
#if LOOKS
        if (LAYER_LOOK(i) != 0) opacity = solidOpacity(i, opacity, doi);
#endif
        float lengths = ray.stepLength * REFERENCE_LENGTHS * layerMap[i].z;
        float thickness = lengths * share * clipCoverage(float(k)) * float(together);
        float alpha = correctedOpacity(opacity, thickness);
        bool surface = LAYER_SHADED(i) == 1 || LAYER_LOOK(i) != 0;
        if (surface && !byGradient) g = cellGradient(LAYER_FIELD(i), p, present(s) ? s.x : kUnknown, alpha > 0.0);
        float fade = min(1.0, length(g) * abs(layerMap[i].x) / kFlatGradient);
        vec3 albedo = c.rgb, drawn = g;
#if LOOKS
        LookSample look;
        if (LAYER_LOOK(i) != 0) {
            drawn = lookGradient(i, LAYER_FIELD(i), readAt(LAYER_FIELD(i), p), p, present(s) ? s.x : kUnknown, g,
                                 alpha > 0.0);
            look = lookSample(i, LAYER_FIELD(i), p, present(s) ? s.x : kUnknown, g, drawn, fade, world, distanceAt(at),
                              ray.direction, doi, alpha > 0.0);
            alpha = correctedOpacity(lookOpacity(i, opacity, look), thickness);
            c.rgb = lookAlbedo(i, albedo, look);
        }
#endif
        c.rgb = LAYER_SHADED(i) == 1 ? shade(c.rgb, shadingGradient(drawn), fade, world, -ray.direction)
                                     : shadeFlat(c.rgb, world);
#if LOOKS
        if (LAYER_LOOK(i) != 0) c.rgb = lookColor(i, albedo, c.rgb, look);
#endif
        show(Met(at, vec4(c.rgb * alpha, alpha), focusInterest(doi, LAYER_BRUSHED(i))));
    }
}
#endif
