// Slot fetch: each channel is a single texture.
#include "lib/sampling/filtered.glsl"

// Filtered texel at p on the even sublattice (fetchOdd: odd). CC: value, coverage; BCC: see vis/bricks/texels.h.
vec4 fetchEven(int field, vec3 p) {
    return filtered(fieldTexture[field], p * fieldScale[field] + fieldOffset[field]);
}
vec4 fetchOdd(int field, vec3 p) {
    return filtered(fieldTexture[field], p * fieldScale[field] + fieldOffset[field] + fieldOdd[field]);
}

// Announces reads within two texels of p, until releasePage().
void holdPage(int field, vec3 p) {}
void releasePage() {}

// Whether p is drawn at full resolution.
bool fineAt(int field, vec3 p) {
    return fieldLevel[field] == 0;
}

// Cell edge of the level drawn at p, in full-resolution cells.
float cellEdge(int field, vec3 p) {
    return exp2(float(fieldLevel[field]));
}

// The texel with index `at` (even sublattice) at the level of the texture; `at` is near p.
vec4 fetchTexel(int field, ivec3 at, vec3 p) {
    return texelFetch(fieldTexture[field], clamp(at + HALO, ivec3(0), textureSize(fieldTexture[field], 0) - 1), 0);
}

// Continuous index within a sublattice, at the level of the texture.
vec3 sublatticeIndex(int field, vec3 p, int sublattice) {
    vec3 u = p * fieldScale[field] + fieldOffset[field];
    if (sublattice == 1) u += fieldOdd[field];
    return u * vec3(textureSize(fieldTexture[field], 0)) - (float(HALO) + 0.5);
}
