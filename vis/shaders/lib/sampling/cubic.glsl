// Cubic B-splines from linear reads: two samples beside each other, weighted, are one read between them, so eight
// trilinear reads give the 64 samples of a sublattice (C. Sigg, M. Hadwiger, Fast third-order texture filtering, GPU
// Gems 2, 2005). Twin: volume/reconstruct/cubic.h.
//   CUBIC     1 with this filter; FIELD_CUBIC(i): 0 for fields whose samples are read as they are

// Two reads along each axis: their places relative to p in samples of the level, and the share of the second.
struct CubicReads {
    vec3 low, high, share;
};
CubicReads cubicReads(vec3 index) {
    vec3 f = fract(index), g = 1.0 - f;
    vec3 first = g * g * g / 6.0, last = f * f * f / 6.0;
    vec3 second = 2.0 / 3.0 - f * f * (1.0 - 0.5 * f), third = 2.0 / 3.0 - g * g * (1.0 - 0.5 * g);
    return CubicReads(second / (first + second) - 1.0 - f, last / (third + last) + 1.0 - f, third + last);
}

// Places beyond those that rays reach are moved there: bricks have no more samples.
vec3 cubicPlace(vec3 p, float edge) {
#ifdef BRICK_TEXELS
    vec3 end = cellsOffset - halfSize * cellsPerWorld, other = cellsOffset + halfSize * cellsPerWorld;
    return clamp(p, min(end, other) - 1.5 * edge, max(end, other) + (BCC == 1 ? 1.2 : 1.7) * edge);
#else
    return p;
#endif
}

vec4 cubicSublattice(int field, vec3 p, int sublattice) {
    CubicReads reads = cubicReads(sublatticeIndex(field, p, sublattice));
    float edge = cellEdge(field, p);
    vec4 sum = vec4(0.0);
    for (int n = 0; n < cubicCorners; ++n) {
        bvec3 second = bvec3((n & 1) != 0, (n & 2) != 0, (n & 4) != 0);
        vec3 weight = mix(1.0 - reads.share, reads.share, second);
        vec3 at = cubicPlace(p + mix(reads.low, reads.high, second) * edge, edge);
        vec4 texel = sublattice == 1 ? fetchOdd(field, at) : fetchEven(field, at);
        sum += weight.x * weight.y * weight.z * texel;
    }
    return sum;
}
