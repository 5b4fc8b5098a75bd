// Adds one splat to the sums of weighted blended order-independent transparency (M. McGuire, L. Bavoil 2013): colours
// add up and transmittances multiply, so the order of points does not matter.
flat in vec4 splat;
flat in float weight;

layout(location = 0) out vec4 sum;     // blended ONE, ONE
layout(location = 1) out vec4 through; // blended ZERO, ONE_MINUS_SRC_COLOR

void main() {
    vec2 at = gl_PointCoord * 2.0 - 1.0;
    float away = dot(at, at);
    float alpha = splat.a * max(exp(-3.0 * away) - 0.0498, 0.0) * 1.0524; // Gaussian, 0 at the rim, 1 in the middle
    sum = vec4(splat.rgb * alpha, alpha) * weight;
    through = vec4(alpha);
}
