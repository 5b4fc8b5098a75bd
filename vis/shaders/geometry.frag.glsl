// Meshes and lines (LINES) into a layer of surfaces by distance; each layer keeps what lies behind the former one.
#include "lib/light_bindings.glsl"
#include "lib/color.glsl"
#include "lib/clipping.glsl"
#include "lib/lenses.glsl"
#include <slot:shade>
#include "lib/shade.glsl"

in vec3 world, direction;
in float value, side;

uniform vec3 rayOrigin, forward; // of the ray through the middle of the picture
uniform int perspective;
uniform sampler2D colors; // linear light
uniform float row;
uniform vec2 map; // place in the row = value * x + y
uniform vec3 plain;
uniform float opacity;
uniform int lens; // that it is drawn in, -1: everywhere
uniform sampler2DArray former;
uniform int peel;

layout(location = 0) out vec4 outColor;     // linear, premultiplied
layout(location = 1) out float outDistance; // along the ray

void main() {
    if (!clipKept(world)) discard;
    vec2 action = lensAction(lens, world);
    float alpha = min(opacity * action.x, 1.0);
    if (alpha <= 0.0) discard;
    float along = perspective == 1 ? distance(world, rayOrigin) : dot(world - rayOrigin, forward);
    if (peel > 0 && along <= texelFetch(former, ivec3(gl_FragCoord.xy, peel - 1), 0).r) discard;
    vec3 toViewer = perspective == 1 ? normalize(rayOrigin - world) : -forward;
#if LINES
    // As a tube: towards the viewer in the middle, away to the sides.
    vec3 tangent = normalize(direction), across = cross(tangent, toViewer);
    across = dot(across, across) > 1e-8 ? normalize(across) : vec3(0.0);
    vec3 normal = cross(across, tangent) * sqrt(max(0.0, 1.0 - side * side)) + across * side;
#else
    vec3 normal = direction;
    if (dot(normal, normal) < 1e-20) normal = cross(dFdx(world), dFdy(world));
#endif
    float entries = float(textureSize(colors, 0).x), place = clamp(value * map.x + map.y, 0.0, 1.0);
    vec3 color = isnan(value) ? plain : textureLod(colors, vec2((place * (entries - 1.0) + 0.5) / entries, row), 0.0).rgb;
    color = mix(vec3(luminance(color)), color, action.y);
    outColor = vec4(shade(color, normal, 1.0, world, toViewer) * alpha, alpha);
    outDistance = along;
}
