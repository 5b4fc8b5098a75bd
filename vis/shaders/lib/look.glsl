// Shading formulas of looks; formulas and papers in the twins: vis/optics/look_shading.h. A sample with share or weight
// 0 is unchanged.

// Inputs of a look: n.l of the visible side, |n.v|, the rest as in LookSample (C++).
struct LookSample {
    float light, facing, weight, steepness, curvature, depth, pixel, share, wire;
    vec2 grain;
};

// `own` = retained, strength, exponent of an enhancement.
float boundaryFactor(vec3 own, LookSample at) {
    return own.x + own.y * pow(clamp(at.steepness, 1e-6, 1.0), own.z);
}
float silhouetteFactor(vec3 own, LookSample at) {
    return own.x + own.y * at.weight * pow(max(1.0 - at.facing, 1e-6), own.z);
}

// Coverage of a pixel by the intersection lines of a surface with planes at multiples of `spacing` along x, y and z;
// lines are `width` pixels wide.
float wireCoverage(vec3 world, vec3 normal, vec3 toViewer, float spacing, float width, float pixel) {
    float along = dot(normal, toViewer), covered = 0.0;
    along = along < 0.0 ? min(along, -0.02) : max(along, 0.02);
    for (int axis = 0; axis < 3; ++axis) {
        vec3 change = -toViewer[axis] / along * normal; // of the coordinate, per world unit across the picture
        change[axis] += 1.0;
        float gap = spacing / max(length(change) * pixel, 1e-6); // pixels
        float x = world[axis] / spacing, away = abs(x - floor(x + 0.5)) * gap;
        float line = mix(clamp(0.5 * width + 0.5 - away, 0.0, 1.0), min(width / gap, 1.0), clamp(2.0 - 0.5 * gap, 0.0, 1.0));
        covered = max(covered, line * smoothstep(0.1, 0.35, sqrt(max(0.0, 1.0 - normal[axis] * normal[axis]))));
    }
    return covered;
}

float outline(float facing, float curvature, float thickness) {
    float bent = min(1.0, thickness * curvature);
    float limit = sqrt(bent * (2.0 - bent));
    return 1.0 - smoothstep(0.5, 1.0, facing / max(limit, 1e-6));
}

float lightStep(float light, float steps) {
    return min(steps - 1.0, floor(steps * max(0.0, light))) / (steps - 1.0);
}

// `tone` = contrast, steepness, 1 for chalk; `line` = width in pixels, strength, closure; `mark` = half the softness of
// the grain, strokes, smudge, pressure.
float charcoalInk(vec3 lit, LookSample at, vec3 tone, vec3 line, vec4 mark) {
    float bright = sqrt(clamp(dot(lit, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0));
    float drawn = tone.z > 0.5 ? bright : 1.0 - bright;
    float steep = mix(1.0, sqrt(clamp(at.steepness, 0.0, 1.0)), tone.y);
    float filled = (drawn > 0.0 ? pow(drawn, tone.x) : 0.0) * steep;
    float open = mix(1.0, smoothstep(0.1, 0.6, 1.0 - bright), line.z);
    float drawnLine = line.y * at.weight * open * outline(at.facing, at.curvature, line.x * at.pixel);
    float density = mark.w * (1.0 - (1.0 - filled) * (1.0 - drawnLine));
    float stroked = min(1.0, density * (1.0 + mark.y * (2.0 * at.grain.y - 1.0)));
    float ink = smoothstep(at.grain.x - mark.x, at.grain.x + mark.x, stroked * (1.0 + 2.0 * mark.x) - mark.x);
    return mix(ink, density, mark.z);
}

vec3 toned(vec3 albedo, float light, vec3 warm, vec3 cool, float ownColor) {
    return mix(cool, warm, 0.5 + 0.5 * light) + ownColor * max(light, 0.0) * albedo;
}
