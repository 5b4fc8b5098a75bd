// Layers that take their colours from another channel. COLORED: 1 where one does; LAYER_COLORED(i) which;
// LAYER_COLOR(i): that channel's field; LAYER_COLOR_ROW(i): its row of the transfer table. Twin: Prepared::tinted in
// vis/reference/prepared.h.
#if LAYERS > 0

// Colour (linear) of layer i for what a reading of that channel gives: where it is absent, the layer's plain one.
vec3 colorOfReading(int i, float value, bool is, vec3 own) {
#if COLORED
    if (LAYER_COLORED(i) == 1)
        return is ? tableAt(LAYER_COLOR_ROW(i), value * layerColorMap[i].x + layerColorMap[i].y).rgb : layerColor[i];
#endif
    return own;
}

// Colour (linear) of layer i at p in place of its own.
vec3 colorBy(int i, vec3 p, vec3 own) {
#if COLORED
    if (LAYER_COLORED(i) == 1) {
        vec2 s = reconstruct(LAYER_COLOR(i), p);
        return colorOfReading(i, s.x, present(s), own);
    }
#endif
    return own;
}
#endif
