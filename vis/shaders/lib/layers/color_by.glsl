// Layers coloured by another channel. COLORED: 1 if there is one; LAYER_COLORED(i): 1 if layer i is; LAYER_COLOR(i):
// field of the other channel; LAYER_COLOR_ROW(i): its row of the transfer table. Twin: Prepared::tinted in
// tests/reference/prepared.h.
#if LAYERS > 0

// Colour (linear) of layer i for a value of that channel; the layer's plain colour where it is absent.
vec3 colorOfReading(int i, float value, bool is, vec3 own) {
#if COLORED
    if (LAYER_COLORED(i) == 1)
        return is ? tableAt(LAYER_COLOR_ROW(i), value * layerColorMap[i].x + layerColorMap[i].y).rgb : layerColor[i];
#endif
    return own;
}

// Colour (linear) of layer i at p; `own` if it is not coloured by another channel.
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
