// Strokes of slices, pictures made by line integral convolution; twin: sliceStrokes in vis/scene/strokes.h.
#if STROKES
// Lightness (-1..1) times coverage, and coverage, of slice i at a place of the world: linear between texels, constant
// beyond the outermost ones.
vec2 sliceStrokes(int i, vec3 world) {
    vec2 at = vec2(dot(strokeAcross[i].xyz, world) + strokeAcross[i].w, dot(strokeUp[i].xyz, world) + strokeUp[i].w) - 0.5;
    vec2 low = floor(at), share = at - low, most = strokeSize[i].xy - 1.0;
    ivec2 a = ivec2(clamp(low, vec2(0.0), most)), b = ivec2(clamp(low + 1.0, vec2(0.0), most));
    int layer = int(strokeSize[i].z);
    vec2 below = mix(texelFetch(strokeTexture, ivec3(a.x, a.y, layer), 0).rg,
                     texelFetch(strokeTexture, ivec3(b.x, a.y, layer), 0).rg, share.x);
    vec2 above = mix(texelFetch(strokeTexture, ivec3(a.x, b.y, layer), 0).rg,
                     texelFetch(strokeTexture, ivec3(b.x, b.y, layer), 0).rg, share.x);
    return mix(below, above, share.y);
}
#endif
