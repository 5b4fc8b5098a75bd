// A channel at a time between two stored ones: absent samples take no part, so a place is present where enough of both
// frames is. Included by the slots of reconstruction, which define reconstructFrame. Twin: SeriesSamples in
// vis/reference/samples.h.
//   LATER    fields i + LATER hold the later frames of fields i; 0: every field is on a stored time

#if defined(LATER) && LATER > 0
uniform vec3 laterFrame[LATER]; // texel units of the later frame to those of the earlier: x * value + y; z its weight
#endif

vec2 reconstruct(int field, vec3 p) {
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
