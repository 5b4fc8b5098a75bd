// Extinction per world unit (a) and extinction times colour (rgb) of each light grid cell, by the formula in
// vis/optics/light_volume.h. Pixel (x, y + gridSize.y * z) is cell (x, y, z).
#include "lib/bindings/bindings.glsl"
#include "lib/bindings/tables.glsl"
#include "lib/layers/color.glsl"
#include "lib/sampling/ray.glsl"
#include "lib/sampling/clipping.glsl"
#include <slot:fetch>
#include <slot:reconstruct>
#include "lib/sampling/gradient.glsl"
#include "lib/layers/doi.glsl"

#if LAYERS > 0
#include "lib/layers/classify.glsl"
#include "lib/layers/color_by.glsl"
#endif

layout(location = 0) out vec4 outMedium;

uniform ivec3 gridSize;
uniform int mediumSamples; // 8; a uniform, so that the loop is not unrolled

const float kThickest = 0.999;

#if LAYERS > 0
// Colour and opacity of a composite layer's sample, post-classified.
vec4 colorAt(int i, vec3 p, vec2 s) {
    float x = s.x * layerMap[i].x + layerMap[i].y;
    vec3 g = vec3(0.0);
    if (LAYER_GRADIENT(i) == 1 || LAYER_LOOKUP(i) == LOOKUP_PLANE)
        g = cellGradient(LAYER_FIELD(i), p, s.x, s.y >= PRESENT_COVERAGE);
    if (LAYER_GRADIENT(i) == 1) x = gradientPlace(i, g);
#if HAS_PLANES
    if (LAYER_LOOKUP(i) == LOOKUP_PLANE) return planeAt(LAYER_PLANE(i), vec2(x, gradientPlace(i, g)));
#endif
    return transfer(i, x);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec3 cell = ivec3(pixel.x, pixel.y % gridSize.y, pixel.y / gridSize.y);
    vec3 edges = 2.0 * halfSize / vec3(gridSize);
    vec3 center = (vec3(cell) + 0.5) * edges - halfSize;
    vec4 sum = vec4(0.0);
#if LAYERS > 0
    float mean[LAYERS], points[LAYERS];
    vec3 slope[LAYERS];
#if PARTS
    float part[LAYERS]; // part of the first point; a surface lies within one part
#endif
    for (int i = 0; i < LAYERS; ++i) {
        mean[i] = 0.0; points[i] = 0.0; slope[i] = vec3(0.0);
    }
    for (int n = 0; n < mediumSamples; ++n) {
        vec3 way = vec3(n & 1, n >> 1 & 1, n >> 2) - 0.5;
        vec3 world = center + 0.5 * way * edges, p = toCells(world);
        float doi = degreeOfInterest(p), kept = clipKept(world) ? 1.0 : 0.0;
        for (int i = 0; i < LAYERS; ++i) {
            Reading s = readAt(LAYER_FIELD(i), p);
            bool is = present(s);
            if (LAYER_STYLE(i) == STYLE_COMPOSITE) {
                vec4 c = colorAt(i, p, s.xy);
                c.rgb = colorBy(i, p, c.rgb);
                vec2 lens = lensAction(LAYER_LENS(i), world, doi);
                float factor = kept * focusOpacity(doi, LAYER_BRUSHED(i));
                float own = -log(1.0 - min(c.a * factor * lens.x, kThickest)) * layerMap[i].z * REFERENCE_LENGTHS;
                sum += is ? vec4(focusColor(c.rgb, doi, lens.y, LAYER_BRUSHED(i)), 1.0) * (own / 8.0) : vec4(0.0);
            } else if (LAYER_STYLE(i) == STYLE_ISO) {
                mean[i] += s.x / 8.0;
#if PARTS
                if (n == 0) part[i] = s.z;
                is = is && s.z == part[i];
#endif
                points[i] += is ? 1.0 : 0.0;
                slope[i] += way * s.x / edges; // 8 * (1/2) / 4 * (upper - lower mean) / (edge / 2)
            }
        }
    }
    float longest = max(max(edges.x, edges.y), edges.z), middle = degreeOfInterest(toCells(center));
    for (int i = 0; i < LAYERS; ++i) {
        if (LAYER_STYLE(i) != STYLE_ISO) continue;
        float away = abs(mean[i] - layerMap[i].z) / max(length(slope[i]), 1e-20);
        vec2 lens = lensAction(LAYER_LENS(i), center, middle);
        float alpha = min(layerMap[i].w * focusOpacity(middle, LAYER_BRUSHED(i)) * lens.x, kThickest);
        float dense = -log(1.0 - alpha) * max(0.0, 1.0 - away / longest) / longest;
        bool is = points[i] > 7.5 && clipKept(center);
        vec3 own = colorBy(i, toCells(center), layerColor[i]);
        sum += is ? vec4(focusColor(own, middle, lens.y, LAYER_BRUSHED(i)), 1.0) * dense : vec4(0.0);
    }
#endif
    outMedium = sum;
}
