// Interpolated reads. GPUs place such a read between two texels in steps of 1/256, which shows where opacity is steep
// and at surfaces. FILTER_IN_SHADER interpolates with the precision of floats (Driver::exactFilter).

// Trilinear; `place` in 0..1, clamped to the border texels.
vec4 filtered(sampler3D from, vec3 place) {
#ifdef FILTER_IN_SHADER
    ivec3 last = textureSize(from, 0) - 1;
    vec3 at = place * vec3(last + 1) - 0.5, below = floor(at), share = at - below;
    ivec3 lo = clamp(ivec3(below), ivec3(0), last), hi = clamp(ivec3(below) + 1, ivec3(0), last);
    vec4 near = mix(mix(texelFetch(from, lo, 0), texelFetch(from, ivec3(hi.x, lo.yz), 0), share.x),
                    mix(texelFetch(from, ivec3(lo.x, hi.y, lo.z), 0), texelFetch(from, ivec3(hi.xy, lo.z), 0), share.x),
                    share.y);
    vec4 far = mix(mix(texelFetch(from, ivec3(lo.xy, hi.z), 0), texelFetch(from, ivec3(hi.x, lo.y, hi.z), 0), share.x),
                   mix(texelFetch(from, ivec3(lo.x, hi.yz), 0), texelFetch(from, hi, 0), share.x), share.y);
    return mix(near, far, share.z);
#else
    return textureLod(from, place, 0.0);
#endif
}

// Bilinear, of a tile that repeats, whose edge is a power of two; `at` in texels.
vec4 filteredTile(sampler2D tile, vec2 at) {
    int edge = textureSize(tile, 0).x;
#ifdef FILTER_IN_SHADER
    vec2 below = floor(at - 0.5), share = at - 0.5 - below;
    ivec2 lo = ivec2(below) & (edge - 1), hi = (ivec2(below) + 1) & (edge - 1);
    return mix(mix(texelFetch(tile, lo, 0), texelFetch(tile, ivec2(hi.x, lo.y), 0), share.x),
               mix(texelFetch(tile, ivec2(lo.x, hi.y), 0), texelFetch(tile, hi, 0), share.x), share.y);
#else
    return textureLod(tile, at / float(edge), 0.0);
#endif
}
