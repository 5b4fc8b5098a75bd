// Contour lines of slices; twin of vis/optics/contour.h, which says what the parameters are.
vec3 withContours(vec3 c, float level, float width, float count) {
    if (!(width > 0.0)) return c;
    float away = abs(level - clamp(floor(level + 0.5), 1.0, count)) / width;
    return mix(c, vec3(luminance(c) > 0.18 ? 0.0 : 1.0), 0.75 * clamp(1.2 - away, 0.0, 1.0) / max(1.0, width * 2.0));
}
