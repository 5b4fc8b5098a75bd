// Slot fetch: bricks of any level in an atlas. A page table with one entry per full-resolution brick stores the atlas
// position and the level of the resident brick: one fetch each, whatever the level. Both sublattices use the brick that
// contains p; its halo holds the samples that either needs.
#include "lib/sampling/filtered.glsl"
uniform usampler3D pageTable[FIELDS];
uniform sampler3D atlas[FIELDS];

const uint kDeepest = 15u; // larger values instead of a level: absent or not resident

ivec3 brickAt(int field, vec3 p) {
    return clamp(ivec3(floor(p / float(BRICK_TEXELS))), ivec3(0), textureSize(pageTable[field], 0) - 1);
}

struct Page {
    vec3 texel;  // position of p in the atlas, in texels, on the even sublattice
    float scale; // texels per cell, 2^-level; 0: absent
};

Page pageAt(int field, vec3 p) {
    ivec3 brick = brickAt(field, p);
    uvec4 page = texelFetch(pageTable[field], brick, 0);
    float scale = page.w > kDeepest ? 0.0 : exp2(-float(page.w));
    return Page((p - vec3(brick * BRICK_TEXELS)) * scale - levelPhase * (1.0 - scale) + vec3(page.xyz) +
                    (float(HALO) + 0.5),
                scale);
}

// Within a brick and its halo one page suffices: positions near p are looked up in the brick of p. (Not on BCC, where
// it was no faster, nor if parts have their own pages, nor for a cubic kernel, which reads further.)
Page heldPage = Page(vec3(0.0), 0.0);
vec3 heldAt = vec3(0.0);
bool held = false;

void holdPage(int field, vec3 p) {
#if LATER == 0 && !PARTS && !LENS_BENDS && !BCC && !CUBIC
    heldPage = pageAt(field, p);
    heldAt = p;
    held = true;
#endif
}
void releasePage() {
    held = false;
}

Page pageFor(int field, vec3 p) {
    if (held) return Page(heldPage.texel + (p - heldAt) * heldPage.scale, heldPage.scale);
    return pageAt(field, p);
}

vec4 fetchEven(int field, vec3 p) {
    Page page = pageFor(field, p);
    vec4 texel = filtered(atlas[field], page.texel * atlasInverse[field]);
    return page.scale > 0.0 ? texel : vec4(0.0);
}
vec4 fetchOdd(int field, vec3 p) {
    Page page = pageFor(field, p);
    vec4 texel = filtered(atlas[field], (page.texel - 0.5 * page.scale) * atlasInverse[field]);
    return page.scale > 0.0 ? texel : vec4(0.0);
}

// Whether p is drawn at full resolution.
bool fineAt(int field, vec3 p) {
    float scale = pageAt(field, p).scale;
    return scale == 0.0 || scale == 1.0;
}

// Cell edge of the level drawn at p, in full-resolution cells.
float cellEdge(int field, vec3 p) {
    float scale = pageFor(field, p).scale;
    return scale > 0.0 ? 1.0 / scale : 1.0;
}

// The texel with index `at` (even sublattice) at the level drawn at p; `at` is near p.
vec4 fetchTexel(int field, ivec3 at, vec3 p) {
    ivec3 brick = brickAt(field, p);
    uvec4 page = texelFetch(pageTable[field], brick, 0);
    if (page.w > kDeepest) return vec4(0.0);
    ivec3 first = (brick * BRICK_TEXELS) >> int(page.w);
    return texelFetch(atlas[field], at - first + ivec3(page.xyz) + HALO, 0);
}

// Continuous index within a sublattice, at the level drawn at p.
vec3 sublatticeIndex(int field, vec3 p, int sublattice) {
    float scale = pageAt(field, p).scale;
    if (scale == 0.0) scale = 1.0;
    return (p - (sublattice == 1 ? 0.5 : 0.0)) * scale - levelPhase * (1.0 - scale);
}
