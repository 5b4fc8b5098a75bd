// Degree of interest at a position; twin: DoiFunction in vis/scene/selection.h. Brushes are stored as consecutive tests
// (vis/raycast/brush_uniforms.h); kinds of tests that no brush uses are not compiled.

#if BRUSH_COLORS
vec4 brushHolder = vec4(0.0); // by the last degreeOfInterest(): colour of the brush that holds p most; how much
#endif

#if BRUSH_TESTS > 0
// 1 up to radius 1, then linear to 0 at 1 + soft; `inverseSoft` is 1e30 for a hard edge.
float radialDoi(float radii, float inverseSoft) {
    return radii > 1.0 ? max(0.0, 1.0 - (radii - 1.0) * inverseSoft) : 1.0;
}

#if BRUSH_LASSOS
// Entry (i, j) of the lasso table that starts at row `row`.
float lassoEntry(int row, int i, int j) {
    return texelFetch(lassoTables, ivec2(i, row + j), 0).x;
}

// `place` in table entries; bilinear, 0 outside the table.
float lassoDoi(int row, vec2 place) {
    const float kLast = float(LASSO_TABLE - 1);
    bool inside = place.x >= 0.0 && place.y >= 0.0 && place.x <= kLast && place.y <= kLast;
    ivec2 at = ivec2(clamp(place, vec2(0.0), vec2(kLast - 1.0)));
    vec2 f = place - vec2(at);
    float lower = mix(lassoEntry(row, at.x, at.y), lassoEntry(row, at.x + 1, at.y), f.x);
    float upper = mix(lassoEntry(row, at.x, at.y + 1), lassoEntry(row, at.x + 1, at.y + 1), f.x);
    return inside ? mix(lower, upper, f.y) : 0.0;
}
#endif
#endif

float degreeOfInterest(vec3 p) {
#if BRUSH_TESTS > 0
#if BRUSH_FIELDS > 0
    vec2 samples[BRUSH_FIELDS];
    for (int i = 0; i < BRUSH_FIELDS; ++i) samples[i] = reconstruct(BRUSH_FIELD(i), p);
#endif
    float doi = brushStart, own = 1.0, there = 1.0;
#if BRUSH_COLORS
    vec4 most = vec4(0.0);
#endif
    for (int i = 0; i < brushTestCount; ++i) {
        ivec4 meaning = brushMeaning[i]; // kind, first field or -1, second field, flags
        vec4 a = brushShape[2 * i], b = brushShape[2 * i + 1];
        if ((meaning.w & 1) != 0) own = there = 1.0;
        float test = meaning.x == BRUSH_TEST_ALWAYS ? 1.0 : 0.0;
        bool both = false; // values that the test asks for are present
#if BRUSH_FIELDS > 0
        vec2 x = samples[0], y = samples[0];
        for (int j = 1; j < BRUSH_FIELDS; ++j) {
            if (meaning.y == j) x = samples[j];
            if (meaning.z == j) y = samples[j];
        }
        both = x.y >= PRESENT_COVERAGE && y.y >= PRESENT_COVERAGE && meaning.y >= 0 && meaning.z >= 0;
#if BRUSH_RANGES
        float outside = max(max(a.x - x.x, x.x - a.y), 0.0);
        if (meaning.x == BRUSH_TEST_RANGE) test = both ? (outside > 0.0 ? max(0.0, 1.0 - outside * a.z) : 1.0) : 0.0;
#endif
#if BRUSH_ELLIPSES || BRUSH_LASSOS
        vec2 away = (vec2(x.x, y.x) - a.xy) * a.zw;
#endif
#if BRUSH_ELLIPSES
        float squared = (dot(away, away) - 2.0 * b.x * away.x * away.y) * b.y;
        if (meaning.x == BRUSH_TEST_ELLIPSE) test = both ? radialDoi(sqrt(max(squared, 0.0)), b.z) : 0.0;
#endif
#if BRUSH_LASSOS
        if (meaning.x == BRUSH_TEST_LASSO) test = both ? lassoDoi(int(b.x), (away + 1.0) * (0.5 * float(LASSO_TABLE - 1))) : 0.0;
#endif
#endif
#if BRUSH_SPACE
        vec3 from = abs((dataCells(p) - a.xyz) * b.xyz);
        if (meaning.x == BRUSH_TEST_SPHERE) test = radialDoi(length(from), a.w);
        if (meaning.x == BRUSH_TEST_BOX) test = radialDoi(max(from.x, max(from.y, from.z)), a.w);
#endif
#if BRUSH_LENSES
        if (meaning.x == BRUSH_TEST_LENS) {
            vec3 world = fromCells(dataCells(p));
            for (int j = 0; j < LENSES; ++j)
                if ((meaning.y >> j & 1) != 0) test = max(test, lensWeightAt(j, world));
        }
#endif
        bool asks = meaning.x == BRUSH_TEST_RANGE || meaning.x == BRUSH_TEST_ELLIPSE || meaning.x == BRUSH_TEST_LASSO;
        if (asks && !both) there = 0.0;
        own = min(own, test);
        if ((meaning.w & 2) != 0) {
#if BRUSH_COLORS
            float held = own * brushOwnColor[i].w;
            if (held > most.w) most = vec4(brushOwnColor[i].rgb, held);
#endif
            if ((meaning.w & 4) != 0) own = 1.0 - own;
            if ((meaning.w & 16) != 0) own = min(own, there);
            doi = (meaning.w & 8) != 0 ? max(doi, own) : min(doi, own);
        }
    }
#if BRUSH_COLORS
    brushHolder = most;
#endif
    return lensConfine(doi, fromCells(p));
#else
    return 1.0;
#endif
}

// Opacity factor of a layer with this effect of brushes (BrushEffect in vis/scene/brush_effect.h).
float focusOpacity(float doi, int effect) {
    return effect == BRUSHED_FADE      ? mix(context.x, 1.0, doi)
           : effect == BRUSHED_NONE    ? 1.0
           : effect == BRUSHED_CONTEXT ? 1.0 - doi
                                       : doi;
}

// Degree of interest used for context blur.
float focusInterest(float doi, int effect) {
    return effect == BRUSHED_NONE ? 1.0 : doi;
}

// Desaturates a colour, also by the factor `saturation`, changes its lightness, and mixes in the colour of the brush
// that holds the position of the last degreeOfInterest() most.
vec3 focusColor(vec3 color, float doi, float saturation, int effect) {
    float share = effect == BRUSHED_FADE ? doi : 1.0;
    vec3 c = mix(vec3(luminance(color)), color, mix(context.y, 1.0, share) * saturation);
    float lightness = mix(context.z, 1.0, share);
    c = mix(c * min(lightness, 1.0), vec3(1.0), max(lightness - 1.0, 0.0));
#if BRUSH_COLORS
    c = mix(c, brushHolder.rgb, effect == BRUSHED_NONE ? 0.0 : brushHolder.a * doi * brushColorShare);
#endif
    return c;
}
