// Points in up to eight dimensions as round splats.
#include "lib/sampling/project4.glsl"

layout(location = 0) in vec4 position; // within a ball of radius 1, along the first four axes
layout(location = 1) in vec4 color;    // linear; a: opacity at the centre of the splat
layout(location = 2) in vec4 further;  // within that ball, along the other axes
layout(location = 3) in vec4 normal;   // in four dimensions, length 1; 0: none

uniform mat4 rotation;        // of the first four axes
uniform mat4 furtherRotation; // of the others
uniform vec4 eyes;
uniform vec2 stereo;
uniform vec2 perPixel; // clip units per picture unit
uniform float radius;  // in pixels, of a splat that is not magnified
uniform float opacityPower;
uniform vec4 light;    // towards it, in the picture's four dimensions, length 1; 0: none
uniform float ambient; // light that comes from everywhere

flat out vec4 splat; // linear colour, opacity
flat out float weight;

// Twin: litBy() in vis/shapes/cloud4.h.
float litBy(vec4 turned) {
    return dot(light, light) > 0.0 && dot(turned, turned) > 0.0 ? ambient + (1.0 - ambient) * abs(dot(turned, light))
                                                                : 1.0;
}

void main() {
    vec4 placed = project4(rotation * position + furtherRotation * further, eyes, stereo);
    gl_Position = vec4(placed.xy * perPixel, placed.z * 2.0 - 1.0, 1.0);
    float wanted = radius * placed.w;
    // A splat is at least a pixel wide; smaller ones are fainter instead.
    float drawn = max(wanted, 0.75);
    gl_PointSize = 2.0 * drawn + 1.0;
    float opacity = 1.0 - pow(1.0 - min(color.a, 0.999), opacityPower);
    splat = vec4(color.rgb * litBy(rotation * normal), opacity * wanted * wanted / (drawn * drawn));
    // McGuire and Bavoil 2013, equation 10, scaled so that sums of many splats fit into half floats.
    float near = 1.0 - clamp(placed.z, 0.0, 1.0);
    weight = clamp(8.0 * near * near * near, 0.01, 8.0);
}
