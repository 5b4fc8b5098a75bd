// Shading formulas of looks; formulas and papers in the twins: vis/optics/look_shading.h. A sample with share or weight
// 0 is unchanged.
#include "formulas/colors.glsl"
#include "formulas/surface_lines.glsl"

// Inputs of a look: n.l of the visible side, |n.v|, the rest as in LookSample (C++). World position, normal and bend of
// the surface say where and which way marks lie.
struct LookSample {
    float light, facing, weight, steepness, curvature, depth, pixel, share, wire, cut;
    vec3 world, normal, bend;
};

// `own` = retained, strength, exponent of an enhancement.
float boundaryFactor(vec3 own, LookSample at) {
    return own.x + own.y * pow(clamp(at.steepness, 1e-6, 1.0), own.z);
}
float turnedAway(float exponent, LookSample at) {
    return pow(max(1.0 - at.facing, 1e-6), exponent);
}
float silhouetteFactor(vec3 own, LookSample at) {
    return own.x + own.y * at.weight * turnedAway(own.z, at);
}

// The ink that shows on a colour.
vec3 inkOn(vec3 ground, vec3 dark, vec3 light) {
    return mix(light, dark, smoothstep(0.03, 0.12, luminance(ground)));
}

// Ink of one layer of strokes. `press`: half the tooth of the look; `soft`: half the softness of the grain.
float strokeInk(float density, float tooth, float stroke, float strokes, float press, float soft) {
    float amount = max(density, 1e-6), covered = pow(amount, 1.0 - press);
    float edge = 0.06 + 0.18 * press, drawn = smoothstep(1.0 - covered - edge, 1.0 - covered + edge, stroke);
    float stroked = mix(density, pow(amount, press) * drawn, strokes);
    return density > 0.0 ? smoothstep(tooth - soft, tooth + soft, stroked * (1.0 + 2.0 * soft) - soft) : 0.0;
}

// Density of tone and of outlines. `tone` = contrast, steepness, 1 if it draws what is light, bare; `line` = width in
// pixels, strength, closure.
vec2 charcoalDensity(vec3 lit, LookSample at, vec4 tone, vec3 line, float pressure) {
    float bright = sqrt(clamp(luminance(lit), 0.0, 1.0));
    float drawn = max((tone.z > 0.5 ? bright : 1.0 - bright) - tone.w, 0.0) / (1.0 - tone.w);
    drawn = drawn > 0.0 ? pow(drawn, tone.x) : 0.0;
    float steep = mix(1.0, sqrt(clamp(at.steepness, 0.0, 1.0)), tone.y);
    float filled = drawn * (tone.z > 0.5 ? drawn : 2.0 - drawn) * steep;
    float open = mix(1.0, smoothstep(0.1, 0.6, 1.0 - bright), line.z);
    float width = line.x * at.pixel, thin = 1.0 - 0.8 * smoothstep(0.12, 0.45, width * at.curvature);
    float outlined = open * thin * outline(at.facing, at.curvature, width);
    float drawnLine = line.y * at.weight * max(outlined, cutLine(at.cut, line.x));
    return pressure * vec2(filled, drawnLine);
}

// `marks`: tooth, strokes, crossing strokes, dots; `mark` = half the softness of the grain, strokes, smudge; `layers` =
// crossing, half the tooth.
float charcoalInk(vec2 density, vec4 marks, vec4 mark, vec2 layers, bool dots) {
    float ink, soft = mark.x, both = 1.0 - (1.0 - density.x) * (1.0 - density.y);
    if (dots) {
        ink = smoothstep(marks.w - soft, marks.w + soft, both * (1.0 + 2.0 * soft) - soft);
    } else {
        float first = min(density.x, mix(layers.x, density.x, 0.4));
        float second = 1.0 - (1.0 - density.x) / max(1.0 - first, 1e-3), tooth = mix(0.5, marks.x, 2.0 * layers.y);
        float line = density.y > 0.0 ? smoothstep(tooth - soft, tooth + soft, density.y * (1.0 + 2.0 * soft) - soft) : 0.0;
        ink = 1.0 - (1.0 - strokeInk(first, marks.x, marks.y, mark.y, layers.y, soft)) *
                        (1.0 - strokeInk(second, marks.x, marks.z, mark.y, layers.y, soft)) * (1.0 - line);
    }
    return mix(ink, both, mark.z);
}

vec3 toned(vec3 albedo, float light, vec3 warm, vec3 cool, float ownColor) {
    return mix(cool, warm, 0.5 + 0.5 * light) * mix(vec3(1.0), albedo, ownColor);
}
