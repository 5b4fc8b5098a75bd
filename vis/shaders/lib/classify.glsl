// From samples to colour (linear, not premultiplied) and opacity of a layer kReferenceLength thick, for the composite
// layers. Twin: classification in vis/reference/raycast.cpp; what the lookups mean stands in vis/model/ray_setup.h.

// Place of the gradient's magnitude, 0..1 and beyond.
float gradientPlace(int layer, vec3 gradient) {
    return length(gradient) * layerMore[layer].x;
}

#if HAS_LATTICE
// Pre-classification: the samples around p are classified, their premultiplied colours interpolated as values are by
// trilinear interpolation (on BCC the mean of both sublattices). `share`: 1 where enough of them are present, else 0.
vec4 latticeColor(int layer, vec3 p, out float share) {
    int field = LAYER_FIELD(layer);
    p = dataCells(p);
    vec4 sum = vec4(0.0);
    float coverage = 0.0;
    for (int corner = 0; corner < latticeCorners; ++corner) { // 8, on BCC 16
        int sublattice = corner >> 3;
        vec3 at = sublatticeIndex(field, p, sublattice), base = floor(at);
        ivec3 offset = ivec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
        vec3 part = mix(1.0 - (at - base), at - base, equal(offset, ivec3(1)));
        vec4 texel = fetchTexel(field, ivec3(base) + offset, p);
#if BCC
        vec2 s = sublattice == 1 ? texel.ga : texel.rb;
#else
        vec2 s = texel.rg;
#endif
        if (FIELD_COVERAGE(field) == 0) s.y = 1.0;
#if defined(LATER) && LATER > 0
        vec4 laterTexel = fetchTexel(field + LATER, ivec3(base) + offset, p);
#if BCC
        vec2 later = sublattice == 1 ? laterTexel.ga : laterTexel.rb;
#else
        vec2 later = laterTexel.rg;
#endif
        if (FIELD_COVERAGE(field + LATER) == 0) later.y = 1.0;
        vec3 frame = laterFrame[field];
        vec2 times = vec2((1.0 - frame.z) * s.y, frame.z * later.y);
        s.x = (times.x * s.x + times.y * (later.x * frame.x + frame.y)) / max(times.x + times.y, 1e-6);
        s.y = times.x + times.y >= PRESENT_COVERAGE ? 1.0 : 0.0;
#endif
        float weight = part.x * part.y * part.z * s.y;
        vec4 c = transfer(layer, s.x * layerMap[layer].x + layerMap[layer].y);
        sum += weight * vec4(c.rgb * c.a, c.a);
        coverage += weight;
    }
    sum /= max(coverage, 1e-6);
    share = coverage * 8.0 / float(latticeCorners) >= PRESENT_COVERAGE ? 1.0 : 0.0;
    return vec4(sum.rgb / max(sum.a, 1e-12), sum.a);
}
#endif

#if PLANES > 0
// Pre-integration between the places of the values at the two ends of a sample's part of the ray, kUnknown where
// absent. `share`: of that part, what is present.
vec4 slabColor(int layer, float front, float back, out float share) {
    bool hasFront = front > kUnknown, hasBack = back > kUnknown;
    share = (hasFront ? 0.5 : 0.0) + (hasBack ? 0.5 : 0.0);
    return planeAt(LAYER_PLANE(layer), vec2(hasFront ? front : back, hasBack ? back : front));
}

// Place of the value at p, an end of a sample's part.
float slabEnd(int layer, vec3 p) {
    vec2 s = reconstruct(LAYER_FIELD(layer), p);
    return present(s) ? s.x * layerMap[layer].x + layerMap[layer].y : kUnknown;
}
#endif
