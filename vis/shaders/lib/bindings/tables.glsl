// Lookups in the tables of lib/bindings/bindings.glsl.

const int kTableSize = TABLE_SIZE;

// Colour (linear) and opacity of a table row at x, clamped to 0..1, linearly interpolated.
vec4 tableAt(int row, float x) {
    float u = clamp(x, 0.0, 1.0) * float(kTableSize - 1);
#ifdef FILTER_IN_SHADER
    int i = int(u);
    return mix(texelFetch(transferTable, ivec2(i, row), 0),
               texelFetch(transferTable, ivec2(min(i + 1, kTableSize - 1), row), 0), u - float(i));
#else
    return textureLod(transferTable, vec2((u + 0.5) / float(kTableSize), float(row)), 0.0);
#endif
}

// The same for a layer, or for slice `use` - LAYERS.
vec4 transfer(int use, float x) {
    return tableAt(TABLE_ROW(use), x);
}

#if PLANES > 0
// Colour (linear) and opacity from a page of planeTable at 0..1 x 0..1, bilinearly interpolated.
vec4 planeAt(int page, vec2 at) {
    vec2 place = clamp(at, 0.0, 1.0) * float(PLANE_SIZE - 1);
#ifdef FILTER_IN_SHADER
    ivec2 lo = ivec2(place), hi = min(lo + 1, ivec2(PLANE_SIZE - 1)), first = ivec2(0, page * PLANE_SIZE);
    vec2 share = place - vec2(lo);
    vec4 c = mix(mix(texelFetch(planeTable, first + lo, 0), texelFetch(planeTable, first + ivec2(hi.x, lo.y), 0), share.x),
                 mix(texelFetch(planeTable, first + ivec2(lo.x, hi.y), 0), texelFetch(planeTable, first + hi, 0), share.x),
                 share.y);
#else
    vec2 texel = place + vec2(0.5, float(page * PLANE_SIZE) + 0.5);
    vec4 c = textureLod(planeTable, texel / vec2(PLANE_SIZE, PLANE_SIZE * PLANES), 0.0);
#endif
    return vec4(c.rgb / max(c.a, 1e-12), c.a);
}
#endif

// Whether transfer(layer, x) can have opacity: entry i holds the maximum of entries i and i + 1.
bool opaqueAt(int layer, float x) {
#if LAYERS > 0
    if (LAYER_INTERVAL(layer) == 1) return x > layerOpaque[layer].x && x < layerOpaque[layer].y;
#endif
    int i = int(clamp(x, 0.0, 1.0) * float(kTableSize - 1));
    return texelFetch(transferTable, ivec2(i, TABLE_ROWS + TABLE_ROW(layer)), 0).a > 0.0;
}
