// Reconstruction of a channel at a position: interpolated between two stored times if necessary, and restricted to the
// part that the position belongs to. Included by the reconstruction slots, which define reconstructFrame. Twins:
// Samples in tests/reference/samples.h, volume/reconstruct/part_choice.h.
//   LATER    field i + LATER holds the later time of field i; 0: all fields are at stored times
//   PARTS    1 if a channel has several parts (volume/field/parts.h), each in its own field: FIELD_PARTS(i) of them,
//            part j > 0 in field FIELD_MORE(i) + j - 1, all in the texel units of field i; PART_MARGIN: kPartMargin

#if defined(LATER) && LATER > 0
uniform vec3 laterFrame[LATER]; // later to earlier texel units: value * x + y; z: weight of the later
#endif

// (value, coverage) of one field. Only present samples are interpolated between two times; the result is present where
// the weighted coverage of both is sufficient.
vec2 reconstructField(int field, vec3 p) {
    vec2 earlier = reconstructFrame(field, p);
#if defined(LATER) && LATER > 0
    if (FIELD_NEAREST(field) == 1) return earlier;
    vec2 later = reconstructFrame(field + LATER, p);
    vec3 frame = laterFrame[field];
    vec2 share = vec2((1.0 - frame.z) * earlier.y, frame.z * later.y);
    float coverage = share.x + share.y;
    earlier = vec2((share.x * earlier.x + share.y * (later.x * frame.x + frame.y)) / max(coverage, 1e-6), coverage);
#endif
    return earlier;
}

// Reading: value, total coverage of all parts, part index, coverage of that part.
#if PARTS
#define Reading vec4

// Reads the part whose samples have the largest weight at p.
Reading readAt(int field, vec3 p) {
    vec2 own = reconstructField(field, p);
    vec4 best = vec4(own, 0.0, own.y);
    for (int j = 1; j < FIELD_PARTS(field); ++j) {
        own = reconstructField(FIELD_MORE(field) + j - 1, p);
        best.y += own.y;
        if (own.y > best.w + PART_MARGIN) best = vec4(own.x, best.y, float(j), own.y);
    }
    return best;
}

// (value, coverage) at p from the samples of the part of `like` only.
vec2 readPart(int field, Reading like, vec3 p) {
    vec2 own = vec2(0.0);
    if (like.z == 0.0) own = reconstructField(field, p);
    for (int j = 1; j < FIELD_PARTS(field); ++j)
        if (like.z == float(j)) own = reconstructField(FIELD_MORE(field) + j - 1, p);
    return own;
}

bool samePart(Reading a, Reading b) {
    return a.z == b.z;
}
#else
#define Reading vec2

Reading readAt(int field, vec3 p) {
    return reconstructField(field, p);
}
vec2 readPart(int field, Reading like, vec3 p) {
    return reconstructField(field, p);
}
bool samePart(Reading a, Reading b) {
    return true;
}
#endif

// (value, coverage) at p; absent if the coverage is below PRESENT_COVERAGE.
vec2 reconstruct(int field, vec3 p) {
    return readAt(field, p).xy;
}
