// Meshes and lines (LINES), depth peeled: each layer keeps the nearest surface behind the previous layer.
#include "lib/bindings/light_bindings.glsl"
#include "lib/layers/color.glsl"
#include "lib/sampling/clipping.glsl"
#include "lib/sampling/lenses.glsl"
#include <slot:shade>
#include "lib/shading/shade.glsl"
#if LOOKS
#include "lib/shading/draw_look.glsl"
uniform int cutByBox; // 1: an iso-surface, which ends where the box cuts it
#endif

in vec3 world, direction;
in float value, side, stroke;
flat in vec4 tint; // linear light and opacity; red below 0: coloured by the value

uniform vec3 rayOrigin, forward; // of the ray through the centre of the picture
uniform int perspective;
uniform sampler2D colors; // linear light
uniform float row;
uniform vec2 map; // transfer function position = value * x + y
uniform vec3 plain;
uniform float opacity;
uniform float strokes; // strength
uniform int lens; // index of the lens that it is drawn in, -1: everywhere
uniform float brushEffect;
uniform sampler2DArray former, formerColors;
uniform int peel;
uniform float rim;  // > 0: the rim around what is drawn, the back of what was made wider, unlit
uniform int covers; // 1: an opaque surface occludes everything behind it

layout(location = 0) out vec4 outColor;     // linear, premultiplied
layout(location = 1) out vec2 outDistance; // distance along the ray; BrushEffect of the layer

#if LOOKS
// Inputs of look shading for a surface. `dx`, `dy`: derivatives of the position with respect to the pixel; `turnX`,
// `turnY`: those of the normal. A surface without a scalar field has maximal steepness, and strokes in one direction.
LookSample surfaceLook(vec3 normal, vec3 toViewer, float along, vec3 dx, vec3 dy, vec3 turnX, vec3 turnY) {
    LookSample at;
    at.share = 1.0;
    at.weight = 1.0;
    at.steepness = 1.0;
    at.depth = clamp((dot(world - rayOrigin, forward) - lookDepth.x) * lookDepth.y, 0.0, 1.0);
    at.pixel = lookPixel.x + lookPixel.y * along;
    float facing = dot(normal, toViewer);
    at.facing = abs(facing);
    vec3 way = lookLight.xyz - world * lookLight.w;
    float front = clamp(0.5 + 0.5 * facing / kEdgeOn, 0.0, 1.0);
    at.light = (2.0 * front - 1.0) * dot(normal, way) * inversesqrt(max(dot(way, way), 1e-12));
    // Curvature in the view direction: derivative of the normal along the tangent that points to the viewer.
    vec3 across = toViewer - facing * normal;
    across *= inversesqrt(max(dot(across, across), 1e-12));
    float xx = dot(dx, dx), yy = dot(dy, dy), xy = dot(dx, dy), x = dot(across, dx), y = dot(across, dy);
    float area = xx * yy - xy * xy;
    vec3 turn = ((x * yy - y * xy) * turnX + (y * xx - x * xy) * turnY) / max(area, 1e-30);
    at.curvature = area > 0.0 ? abs(dot(turn, across)) : 0.0;
    at.world = world;
    at.normal = normal;
    at.bend = vec3(0.0);
    at.wire = 0.0;
    at.cut = cutByBox == 1 ? cutDistance(world, normal, toViewer, halfSize, at.pixel) : kNoCut;
#if (LOOKS & LOOK_WIRE)
    at.wire = wireCoverage(world, normal, toViewer, lookWire[0].x, lookWire[0].y, at.pixel);
#endif
    return at;
}
#endif

void main() {
    vec3 toViewer = perspective == 1 ? normalize(rayOrigin - world) : -forward;
    vec3 dx = dFdx(world), dy = dFdy(world);
#if LINES
    // Shaded as a tube: the normal points to the viewer in the middle and sideways at the edges.
    vec3 tangent = normalize(direction), beside = cross(tangent, toViewer);
    beside = dot(beside, beside) > 1e-8 ? normalize(beside) : vec3(0.0);
    vec3 normal = cross(beside, tangent) * sqrt(max(0.0, 1.0 - side * side)) + beside * side;
#else
    vec3 normal = direction;
    if (dot(normal, normal) < 1e-20) normal = cross(dx, dy);
#endif
#if LOOKS
    vec3 unit = normalize(normal), turnX = dFdx(unit), turnY = dFdy(unit);
#endif
#if !LINES
    if (rim > 0.0 && (dot(normal, toViewer) > 0.0 || dot(direction, direction) < 1e-20)) discard;
#endif
    if (!clipKept(world)) discard;
    vec2 action = lensAction(lens, world);
    float alpha = min(opacity * tint.a * action.x, 1.0);
    if (alpha <= 0.0) discard;
    float along = perspective == 1 ? distance(world, rayOrigin) : dot(world - rayOrigin, forward);
    if (peel > 0 && along <= texelFetch(former, ivec3(gl_FragCoord.xy, peel - 1), 0).r) discard;
    if (peel > 0 && covers == 1 && texelFetch(formerColors, ivec3(gl_FragCoord.xy, peel - 1), 0).a > 0.998) discard;
    float entries = float(textureSize(colors, 0).x), place = clamp(value * map.x + map.y, 0.0, 1.0);
    vec3 color = isnan(value) ? plain : textureLod(colors, vec2((place * (entries - 1.0) + 0.5) / entries, row), 0.0).rgb;
    if (tint.r >= 0.0) color = tint.rgb;
    color = withStrokes(color, stroke, strokes);
    color = mix(vec3(luminance(color)), color, action.y);
#if LOOKS
    LookSample at = surfaceLook(unit, toViewer, along, dx, dy, turnX, turnY);
    alpha = lookOpacity(0, alpha, at);
    if (alpha < 0.002) discard;
    color = lookColor(0, color, shade(lookAlbedo(0, color, at), normal, 1.0, world, toViewer), at);
#else
    color = shade(color, normal, 1.0, world, toViewer);
#endif
    if (rim > 0.0) color = plain;
    outColor = vec4(color * alpha, alpha);
    outDistance = vec2(along, brushEffect);
}
