// Colour in linear light. Twins in vis/optics/ray_setup.h.
#include "formulas/colors.glsl"

// Linear light to sRGB, both 0..1.
vec3 srgbFromLinear(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// Composites `top` (premultiplied) behind `front`.
vec4 under(vec4 front, vec4 top) {
    return front + (1.0 - front.a) * top;
}
