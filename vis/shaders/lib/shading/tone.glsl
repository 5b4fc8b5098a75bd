// Tone mapping to the range of a display; formulas and papers in the twin vis/scene/tone.h. `curve`: TONE_CURVE_NONE,
// ...; `gain` = 2^exposure.
vec3 toneMap(vec3 light, int curve, float gain, float white) {
    if (curve == TONE_CURVE_NONE) return light;
    vec3 x = max(light, vec3(0.0)) * gain;
    if (curve == TONE_CURVE_REINHARD) return x * (1.0 + x / (white * white)) / (1.0 + x);
    return min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3(1.0));
}
