// Slot fetch: bricks at full resolution in an atlas where a channel has them (FIELD_BRICKS(i): 0 none, 1 some, 2 all),
// else the channel's own texture at a coarser level. Each fetch looks its page up; a brick is chosen by p for both
// sublattices, its halo holds what either needs.
uniform usampler3D pageTable[FIELDS];
uniform sampler3D atlas[FIELDS];
uniform vec3 atlasInverse[FIELDS]; // 1 / size in texels

struct Page {
    vec3 texel; // of the atlas: place of p on the even sublattice
    uint state; // 0 coarse, 1 resident, 2 absent
};

Page pageAt(int field, vec3 p) {
    ivec3 brick = clamp(ivec3(floor(p / float(BRICK_TEXELS))), ivec3(0), textureSize(pageTable[field], 0) - 1);
    uvec4 page = texelFetch(pageTable[field], brick, 0);
    return Page(p - vec3(brick * BRICK_TEXELS) + vec3(page.xyz) + (float(HALO) + 0.5), page.w);
}

vec4 fetchAt(int field, vec3 p, vec3 atlasShift, vec3 coarseShift) {
    vec4 coarse = vec4(0.0);
    if (FIELD_BRICKS(field) < 2)
        coarse = textureLod(fieldTexture[field], p * fieldScale[field] + fieldOffset[field] + coarseShift, 0.0);
    if (FIELD_BRICKS(field) == 0) return coarse;
    Page page = pageAt(field, p);
    vec4 fine = textureLod(atlas[field], (page.texel + atlasShift) * atlasInverse[field], 0.0);
    return page.state == 1u ? fine : page.state == 2u ? vec4(0.0) : coarse;
}

vec4 fetchEven(int field, vec3 p) {
    return fetchAt(field, p, vec3(0.0), vec3(0.0));
}
vec4 fetchOdd(int field, vec3 p) {
    return fetchAt(field, p, vec3(-0.5), fieldOdd[field]);
}

// Whether p is drawn at full resolution.
bool fineAt(int field, vec3 p) {
    return FIELD_BRICKS(field) == 2 || (FIELD_BRICKS(field) == 1 && pageAt(field, p).state != 0u) ||
           (FIELD_BRICKS(field) == 0 && fieldLevel[field] == 0);
}

// The texel with (even) index `at` at the level drawn at p, which lies near it.
vec4 fetchTexel(int field, ivec3 at, vec3 p) {
    if (FIELD_BRICKS(field) > 0) {
        Page page = pageAt(field, p);
        ivec3 brick = clamp(ivec3(floor(p / float(BRICK_TEXELS))), ivec3(0), textureSize(pageTable[field], 0) - 1);
        ivec3 texel = at + ivec3(floor(page.texel - p + vec3(brick * BRICK_TEXELS))) - brick * BRICK_TEXELS;
        if (page.state == 1u) return texelFetch(atlas[field], texel, 0);
        if (page.state == 2u) return vec4(0.0);
    }
    return texelFetch(fieldTexture[field], clamp(at + HALO, ivec3(0), textureSize(fieldTexture[field], 0) - 1), 0);
}

// Continuous index within a sublattice, at the level drawn at p.
vec3 sublatticeIndex(int field, vec3 p, int sublattice) {
    if (fineAt(field, p)) return sublattice == 1 ? p - 0.5 : p;
    vec3 u = p * fieldScale[field] + fieldOffset[field];
    if (sublattice == 1) u += fieldOdd[field];
    return u * vec3(textureSize(fieldTexture[field], 0)) - (float(HALO) + 0.5);
}
