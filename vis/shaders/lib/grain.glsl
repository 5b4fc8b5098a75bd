// Object-space paper grain and strokes; formulas in the twin vis/optics/grain.h.

// Grain and stroke values, 0..1, at a world position on a surface. `size`: desired world edge of a texel; `turn`:
// cosine and sine of the rotation of the strokes.
vec2 grainAt(sampler2D tile, vec3 place, vec3 normal, float size, vec2 turn) {
    float octave = log2(max(size, 1e-9)), whole = floor(octave), part = octave - whole;
    vec3 planes = normal * normal * normal * normal;
    planes /= max(planes.x + planes.y + planes.z, 1e-12);
    float edge = float(textureSize(tile, 0).x);
    vec2 sum = vec2(0.0);
    float squares = 0.0;
    for (int scale = 0; scale < 2; ++scale) {
        vec3 texel = place * exp2(-whole - float(scale));
        float share = scale == 0 ? 1.0 - part : part;
        for (int axis = 0; axis < 3; ++axis) {
            float weight = planes[axis] * share;
            vec2 on = (axis == 0 ? texel.yz : axis == 1 ? texel.zx : texel.xy) + 17.3 * float(axis + 1);
            vec2 at = vec2(turn.x * on.x - turn.y * on.y, turn.y * on.x + turn.x * on.y);
            sum += weight * (textureLod(tile, at / edge, 0.0).rg - 0.5);
            squares += weight * weight;
        }
    }
    return clamp(0.5 + sum * inversesqrt(max(squares, 1e-12)), 0.0, 1.0);
}
