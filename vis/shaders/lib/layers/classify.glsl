// Classification of composite layers: from samples to colour (linear, not premultiplied) and opacity of a layer
// kReferenceLength thick. The kinds of classification are defined in vis/optics/ray_setup.h. Twin:
// tests/reference/raycast.cpp.

// Gradient magnitude relative to the transfer function's maximum, 0..1 or above.
float gradientPlace(int layer, vec3 gradient) {
    return length(gradient) * layerMore[layer].x;
}

#if HAS_LATTICE
// Classifies the samples of one field around p (data cells) and sums their premultiplied colours with trilinear weights
// (on BCC over both sublattices); `coverage`: sum of the weights of present samples.
vec4 latticeSum(int layer, int field, vec3 p, out float coverage) {
    vec4 sum = vec4(0.0);
    coverage = 0.0;
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
    return sum;
}

// Pre-classification: the samples around p are classified and their colours interpolated. Of several parts, the one
// with the largest weight is used. `share`: 1 if enough of all samples are present, else 0.
vec4 latticeColor(int layer, vec3 p, out float share) {
    int field = LAYER_FIELD(layer);
    p = dataCells(p);
    float coverage;
    vec4 sum = latticeSum(layer, field, p, coverage);
    float total = coverage;
#if PARTS
    for (int j = 1; j < FIELD_PARTS(field); ++j) {
        float own;
        vec4 other = latticeSum(layer, FIELD_MORE(field) + j - 1, p, own);
        total += own;
        if (own > coverage + PART_MARGIN * float(latticeCorners) / 8.0) {
            sum = other;
            coverage = own;
        }
    }
#endif
    sum /= max(coverage, 1e-6);
    share = total * 8.0 / float(latticeCorners) >= PRESENT_COVERAGE ? 1.0 : 0.0;
    return vec4(sum.rgb / max(sum.a, 1e-12), sum.a);
}
#endif

// Per layer, carried from sample to sample: a value or position (x), kUnknown if absent, and its part.
#if PARTS
#define Noted vec2
const Noted kNothingNoted = vec2(kUnknown, 0.0);
Noted note(Reading s, float x) {
    return vec2(present(s) ? x : kUnknown, s.z);
}
float notedValue(Noted of) {
    return of.x;
}
bool joined(Noted a, Noted b) {
    return a.y == b.y;
}
#else
#define Noted float
const Noted kNothingNoted = kUnknown;
Noted note(Reading s, float x) {
    return present(s) ? x : kUnknown;
}
float notedValue(Noted of) {
    return of;
}
bool joined(Noted a, Noted b) {
    return true;
}
#endif

#if PLANES > 0
// Pre-integration over the ray segment of one sample, between the positions at its two ends, kUnknown if absent.
// `share`: the present fraction of the segment. Between two parts the value jumps, so each part gets half of the
// segment.
vec4 slabColor(int layer, Noted front, Noted back, out float share) {
    float first = notedValue(front), last = notedValue(back);
    bool hasFront = first > kUnknown, hasBack = last > kUnknown;
    share = (hasFront ? 0.5 : 0.0) + (hasBack ? 0.5 : 0.0);
#if PARTS
    if (hasFront && hasBack && !joined(front, back)) {
        vec4 a = planeAt(LAYER_PLANE(layer), vec2(first)), b = planeAt(LAYER_PLANE(layer), vec2(last));
        return vec4((a.rgb * a.a + b.rgb * b.a) / max(a.a + b.a, 1e-12), 1.0 - sqrt((1.0 - a.a) * (1.0 - b.a)));
    }
#endif
    return planeAt(LAYER_PLANE(layer), vec2(hasFront ? first : last, hasBack ? last : first));
}

// Transfer function position of the value at p, one end of a segment.
Noted slabEnd(int layer, vec3 p) {
    Reading s = readAt(LAYER_FIELD(layer), p);
    return note(s, s.x * layerMap[layer].x + layerMap[layer].y);
}
#endif
