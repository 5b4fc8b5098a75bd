// Composites the sums of points.frag.glsl over a background.
#include "lib/layers/color.glsl"

uniform sampler2D sums;
uniform sampler2D throughs;
uniform vec3 background; // linear

out vec4 outColor;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(sums, at, 0);
    float through = texelFetch(throughs, at, 0).r;
    vec3 mean = sum.rgb / max(sum.a, 1e-5);
    outColor = vec4(srgbFromLinear(mix(mean, background, through)), 1.0);
}
