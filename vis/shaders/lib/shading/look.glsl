// Shading formulas of looks; formulas and papers in the twins: vis/optics/look_shading.h. A sample with share or weight
// 0 is unchanged.

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
    return mix(light, dark, smoothstep(0.03, 0.12, dot(ground, vec3(0.2126, 0.7152, 0.0722))));
}

// A coordinate along a surface: x = its change per world unit across the picture, y = whether the surface crosses the
// planes of this coordinate.
vec2 acrossPicture(vec3 normal, vec3 toViewer, int axis) {
    float along = dot(normal, toViewer);
    along = along < 0.0 ? min(along, -0.02) : max(along, 0.02);
    vec3 change = -toViewer[axis] / along * normal;
    change[axis] += 1.0;
    return vec2(length(change), smoothstep(0.1, 0.35, sqrt(max(0.0, 1.0 - normal[axis] * normal[axis]))));
}

// Coverage of a pixel by the intersection lines of a surface with planes at multiples of `spacing` along x, y and z;
// lines are `width` pixels wide.
float wireCoverage(vec3 world, vec3 normal, vec3 toViewer, float spacing, float width, float pixel) {
    float covered = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        vec2 own = acrossPicture(normal, toViewer, axis);
        float gap = spacing / max(own.x * pixel, 1e-6); // pixels
        float x = world[axis] / spacing, away = abs(x - floor(x + 0.5)) * gap;
        float line = mix(clamp(0.5 * width + 0.5 - away, 0.0, 1.0), min(width / gap, 1.0), clamp(2.0 - 0.5 * gap, 0.0, 1.0));
        covered = max(covered, line * own.y);
    }
    return covered;
}

float outline(float facing, float curvature, float thickness) {
    float bent = min(1.0, thickness * curvature);
    float limit = sqrt(bent * (2.0 - bent));
    return 1.0 - smoothstep(0.5, 1.0, facing / max(limit, 1e-6));
}

const float kNoCut = 1e4;

// Distance in pixels from a place of a surface to where a face of the box cuts it off.
float cutDistance(vec3 world, vec3 normal, vec3 toViewer, vec3 halfSize, float pixel) {
    float nearest = kNoCut;
    for (int axis = 0; axis < 3; ++axis) {
        vec2 own = acrossPicture(normal, toViewer, axis);
        float left = max(halfSize[axis] - abs(world[axis]), 0.0);
        nearest = min(nearest, left / max(own.x * pixel, 1e-6) + kNoCut * (1.0 - own.y));
    }
    return nearest;
}
float cutLine(float cut, float width) {
    return clamp(width + 0.5 - cut, 0.0, 1.0);
}

float lightStep(float light, float steps) {
    return min(steps - 1.0, floor(steps * max(0.0, light))) / (steps - 1.0);
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
    float bright = sqrt(clamp(dot(lit, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
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
