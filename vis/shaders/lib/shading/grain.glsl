// Object-space paper grain, strokes and dots; formulas in the twin vis/optics/grain.h.
#include "lib/sampling/filtered.glsl"

const int kStrokeTurns = 8;
const float kCrossingShift = 137.0;
const float kHalfTurn = 3.14159265358979;

// 3. Loops over so many coordinates end at once where no mark is drawn; software GL executes both sides of a branch.
uniform int grainPlaneCount;

// Weights of the three planes.
vec3 grainPlanes(vec3 normal) {
    vec3 planes = normal * normal * normal * normal;
    return planes / max(planes.x + planes.y + planes.z, 1e-12);
}

vec2 onPlane(vec3 place, int axis) {
    return axis == 0 ? place.yz : axis == 1 ? place.zx : place.xy;
}

// Tooth and dots, 0..1, at a world position on a surface. `size`: desired world edge of a texel.
vec2 grainAt(sampler2D tile, vec3 place, vec3 normal, float size, bool needed) {
    float octave = log2(max(size, 1e-9)), whole = floor(octave), part = octave - whole;
    vec3 planes = grainPlanes(normal);
    float sum = 0.0, squares = 0.0, dots = 1.0;
    for (int axis = 0; axis < (needed ? grainPlaneCount : 0); ++axis) {
        for (int scale = 0; scale < 2; ++scale) {
            vec3 texel = place * exp2(-whole - float(scale));
            float weight = planes[axis] * (scale == 0 ? 1.0 - part : part);
            vec3 found = filteredTile(tile, onPlane(texel, axis) + 17.3 * float(axis + 1)).rgb;
            sum += weight * (found.r - 0.5);
            squares += weight * weight;
            dots = min(dots, 1.0 - pow(max(1.0 - found.b, 0.0), 1.0 / max(weight, 1e-3)));
        }
    }
    return vec2(clamp(0.5 + sum * inversesqrt(max(squares, 1e-12)), 0.0, 1.0), dots);
}

// Strokes, 0..1, in the direction `along`. `shift` in texels: other strokes.
float strokesAt(sampler2D tile, vec3 place, vec3 normal, vec3 along, float size, float shift, bool needed) {
    float octave = log2(max(size, 1e-9)), whole = floor(octave), part = octave - whole;
    vec3 planes = grainPlanes(normal);
    float sum = 0.0, squares = 0.0;
    for (int axis = 0; axis < (needed ? grainPlaneCount : 0); ++axis) {
        vec2 way = onPlane(along, axis);
        float turns = atan(way.y, way.x + 1e-9) / kHalfTurn * float(kStrokeTurns), first = floor(turns);
        float second = smoothstep(0.35, 0.65, turns - first);
        for (int next = 0; next < 2; ++next) {
            float number = first + float(next);
            number -= float(kStrokeTurns) * floor(number / float(kStrokeTurns));
            float angle = (0.25 - number / float(kStrokeTurns)) * kHalfTurn, cosine = cos(angle), sine = sin(angle);
            for (int scale = 0; scale < 2; ++scale) {
                vec2 on = onPlane(place * exp2(-whole - float(scale)), axis) + 17.3 * float(axis + 1);
                vec2 at = vec2(cosine * on.x - sine * on.y, sine * on.x + cosine * on.y) + shift;
                float weight = planes[axis] * (next == 0 ? 1.0 - second : second) * (scale == 0 ? 1.0 - part : part);
                sum += weight * (filteredTile(tile, at).g - 0.5);
                squares += weight * weight;
            }
        }
    }
    return clamp(0.5 + sum * inversesqrt(max(squares, 1e-12)), 0.0, 1.0);
}

// A unit vector across a normal.
vec3 acrossNormal(vec3 n) {
    float side = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + n.z);
    return vec3(1.0 + side * n.x * n.x * a, side * n.x * n.y * a, -side * n.x);
}

// Curvature in a tangent direction, times a length.
float bendAlong(vec3 bend, vec3 normal, vec3 along) {
    vec3 first = acrossNormal(normal), second = cross(normal, first);
    float u = dot(first, along), v = dot(second, along);
    return 0.5 * (bend.x + bend.y * (u * u - v * v) + bend.z * 2.0 * u * v);
}

// Direction of strokes on a surface. `bend`: SurfaceBend of the twin.
vec3 strokeDirection(vec3 normal, vec3 bend, float follow, float turn) {
    vec3 first = acrossNormal(normal), second = cross(normal, first);
    vec2 fixedWay = vec2(dot(first, vec3(1.0)), dot(second, vec3(1.0))) * inversesqrt(3.0);
    float most = max(abs(bend.x), length(bend.yz));
    vec2 bent = bend.x * bend.yz / max(most * most, 1e-12);
    vec2 doubled = follow * smoothstep(0.04, 0.2, most) * bent +
                   0.25 * vec2(fixedWay.x * fixedWay.x - fixedWay.y * fixedWay.y, 2.0 * fixedWay.x * fixedWay.y);
    float angle = 0.5 * atan(doubled.y, doubled.x + 1e-9) + turn;
    return cos(angle) * first + sin(angle) * second;
}
