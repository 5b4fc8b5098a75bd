// Slot reconstruct: linear box spline on BCC, from the four corners of the tetrahedron around p (Entezari, Dyer,
// Moeller: Linear and cubic box splines for the BCC lattice, 2004). Twin: tetrahedral() in
// volume/reconstruct/reconstruct.h.
#include "lib/sampling/bcc_nearest.glsl"

// (value, coverage) of a lattice point given in half cells: all coordinates even, or all odd.
vec2 latticePoint(int field, ivec3 corner, vec3 p) {
    vec4 texel = fetchTexel(field, corner >> 1, p);
    vec2 found = (corner.z & 1) == 1 ? texel.ga : texel.rb;
    return FIELD_COVERAGE(field) == 0 ? vec2(found.x, 1.0) : found;
}

// (value, coverage) at p; absent if coverage < PRESENT_COVERAGE. At coarse levels, whose sublattices do not form a BCC
// lattice, the average of both is used.
vec2 reconstructFrame(int field, vec3 p) {
    if (FIELD_NEAREST(field) == 1) return bccNearest(field, p);
    if (!fineAt(field, p)) {
        vec4 even = fetchEven(field, p), odd = fetchOdd(field, p);
        if (FIELD_COVERAGE(field) == 0) return vec2(0.5 * (even.r + odd.g), 1.0);
        return vec2((even.r + odd.g) / max(even.b + odd.a, 1e-6), 0.5 * (even.b + odd.a));
    }
    vec3 h = 2.0 * p;
    vec3 skew = 0.5 * vec3(h.x + h.y, h.x + h.z, h.y + h.z);
    vec3 base = floor(skew), f = skew - base;
    ivec3 n = ivec3(base);
    ivec3 corner = ivec3(n.x + n.y - n.z, n.x - n.y + n.z, -n.x + n.y + n.z);
    ivec3 s0 = ivec3(1, 1, -1), s1 = ivec3(1, -1, 1), s2 = ivec3(-1, 1, 1), t;
    float u;
    if (f.x < f.y) { u = f.x; f.x = f.y; f.y = u; t = s0; s0 = s1; s1 = t; }
    if (f.y < f.z) { u = f.y; f.y = f.z; f.z = u; t = s1; s1 = s2; s2 = t; }
    if (f.x < f.y) { u = f.x; f.x = f.y; f.y = u; t = s0; s0 = s1; s1 = t; }
    vec2 sum = (1.0 - f.x) * latticePoint(field, corner, p);
    corner += s0;
    sum += (f.x - f.y) * latticePoint(field, corner, p);
    corner += s1;
    sum += (f.y - f.z) * latticePoint(field, corner, p);
    corner += s2;
    sum += f.z * latticePoint(field, corner, p);
    return vec2(sum.x / max(sum.y, 1e-6), sum.y);
}

#include "lib/sampling/between_times.glsl"
