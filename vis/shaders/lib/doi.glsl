// Degree of interest of a place; twin: degreeOfInterest() in vis/model/selection.h.

float degreeOfInterest(vec3 p) {
#if BRUSH_FIELDS > 0
    vec2 samples[BRUSH_FIELDS];
    for (int i = 0; i < BRUSH_FIELDS; ++i) samples[i] = reconstruct(BRUSH_FIELD(i), p);
    float doi = combineAny == 1 ? 0.0 : 1.0, own = 1.0;
    for (int i = 0; i < intervalCount; ++i) {
        ivec2 meaning = intervalMeaning[i];
        if ((meaning.y & 1) != 0) own = 1.0;
        if (meaning.x >= 0) {
            vec2 s = samples[0];
            for (int j = 1; j < BRUSH_FIELDS; ++j)
                if (meaning.x == j) s = samples[j];
            float outside = max(max(interval[i].x - s.x, s.x - interval[i].y), 0.0);
            float inside = outside > 0.0 ? max(0.0, 1.0 - outside * interval[i].z) : 1.0;
            own = min(own, s.y < PRESENT_COVERAGE ? 0.0 : inside);
        }
        if ((meaning.y & 2) != 0) {
            if ((meaning.y & 4) != 0) own = 1.0 - own;
            doi = combineAny == 1 ? max(doi, own) : min(doi, own);
        }
    }
    return doi;
#else
    return 1.0;
#endif
}

// Factor on opacity.
float focusOpacity(float doi) {
    return mix(context.x, 1.0, doi);
}

// Colour pulled towards its luminance.
vec3 focusColor(vec3 color, float doi) {
    return mix(vec3(luminance(color)), color, mix(context.y, 1.0, doi));
}
