// The pictures of both eyes in one. Twin: anaglyphOf() in vis/processor/anaglyph.h.
#include "formulas/anaglyph.glsl"
#include "lib/layers/color.glsl"

uniform sampler2D left; // sRGB
uniform sampler2D right;

out vec4 outColor;

vec3 linearFromScreen(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 l = texelFetch(left, at, 0), r = texelFetch(right, at, 0);
    outColor = vec4(srgbFromLinear(anaglyphColor(linearFromScreen(l.rgb), linearFromScreen(r.rgb))), max(l.a, r.a));
}
