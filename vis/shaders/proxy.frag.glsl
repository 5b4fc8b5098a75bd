// Proxy geometry: one of a stack of planes or spheres, textured with composite layers and blended front to back by the
// frame buffer. Defined in vis/shapes/proxy.h.
#include "lib/bindings/bindings.glsl"
#include "lib/bindings/tables.glsl"
#include "lib/layers/color.glsl"
#include "lib/sampling/clipping.glsl"
#include "lib/sampling/ray.glsl"
#include <slot:shade>
#include "lib/shading/shade.glsl"
#include <slot:fetch>
#include <slot:reconstruct>
#include "lib/sampling/gradient.glsl"
#include "lib/layers/doi.glsl"
#include "lib/layers/color_by.glsl"

flat in int surface;

uniform int proxyShells;                 // 1: spheres around the eye, 0: planes
uniform vec3 proxyNormal;                // of the planes
uniform float proxyFirst, proxySpacing;  // of surface 0 and between surfaces, as offset or radius

layout(location = 0) out vec4 outColor; // linear, premultiplied
layout(location = 1) out vec2 outPick; // distance along the ray; large: nothing noticeable

const float kFlatGradient = 0.005, kProxyPickOpacity = 0.02;

void main() {
    vec2 ndc = gl_FragCoord.xy * ndcScale + ndcOffset;
    vec3 origin = rayOrigin + ndc.x * rayOriginX + ndc.y * rayOriginY;
    vec3 direction = normalize(rayDirection + ndc.x * rayDirectionX + ndc.y * rayDirectionY);
    vec2 inside = clipToBox(origin, direction, halfSize);
    inside.x = max(inside.x, rayBegin);
    float at = proxyFirst + float(surface) * proxySpacing;
    float slope = proxyShells == 1 ? 1.0 : dot(proxyNormal, direction);
    float t = proxyShells == 1 ? at : (at - dot(proxyNormal, origin)) / (abs(slope) < 1e-6 ? 1e-6 : slope);
    if (abs(slope) < 1e-6 || t < inside.x || t > inside.y) discard;
    // A surface represents half the distance to either neighbour; the outermost ones also the rest of the box.
    float between = proxySpacing / abs(slope);
    float from = t - between < inside.x ? inside.x : t - 0.5 * between;
    float to = t + between > inside.y ? inside.y : t + 0.5 * between;
    float lengths = (to - from) * REFERENCE_LENGTHS;
    vec3 world = origin + direction * t, p = toCells(world);
    if (!clipKept(world)) discard;
    vec4 color = vec4(0.0);
    for (int i = 0; i < LAYERS; ++i) {
        vec2 s = reconstruct(LAYER_FIELD(i), p);
        vec4 c = transfer(i, s.x * layerMap[i].x + layerMap[i].y);
        c.rgb = colorBy(i, p, c.rgb);
        float doi = degreeOfInterest(p);
        vec2 lens = lensAction(LAYER_LENS(i), world, doi);
        c.rgb = focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i));
        float alpha = present(s) ? correctedOpacity(c.a * focusOpacity(doi, LAYER_BRUSHED(i)) * lens.x, lengths * layerMap[i].z) : 0.0;
        if (LAYER_SHADED(i) == 1) {
            vec3 g = cellGradient(LAYER_FIELD(i), p, s.x, alpha > 0.0);
            float fade = min(1.0, length(g) * abs(layerMap[i].x) / kFlatGradient);
            c.rgb = shade(c.rgb, shadingGradient(g), fade, world, -direction);
        } else {
            c.rgb = shadeFlat(c.rgb, world);
        }
        color = under(color, vec4(c.rgb * alpha, alpha));
    }
    if (color.a <= 0.0) discard;
    outColor = color;
    outPick = vec2(color.a > kProxyPickOpacity ? t : 1e9, 0.0);
}
