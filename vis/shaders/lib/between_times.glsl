// A channel at a place: mixed of two stored times where it lies between them, and of several parts the one that the
// place belongs to. Included by the slots of reconstruction, which define reconstructFrame. Twins: Samples in
// vis/reference/samples.h, volume/reconstruct/part_choice.h.
//   LATER    fields i + LATER hold the later frames of fields i; 0: every field is on a stored time
//   PARTS    1 where a channel has several parts (volume/field/parts.h), each in a field of its own: FIELD_PARTS(i) of them,
//            part j > 0 in field FIELD_MORE(i) + j - 1, all in the texel units of field i; PART_MARGIN: kPartMargin

#if defined(LATER) && LATER > 0
uniform vec3 laterFrame[LATER]; // texel units of the later frame to those of the earlier: x * value + y; z its weight
#endif

// (value, coverage) of one field. Of two times absent samples take no part, so a place is present where enough of both
// frames is.
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

// Reading: value, coverage of all parts, the part that it is of, and the coverage of that part.
#if PARTS
#define Reading vec4

// At p: of the part whose samples carry the most weight there.
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

// (value, coverage) at p by the samples of one part alone, that of a reading.
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

// (value, coverage) at p; the place is absent where the coverage is below PRESENT_COVERAGE.
vec2 reconstruct(int field, vec3 p) {
    return readAt(field, p).xy;
}
