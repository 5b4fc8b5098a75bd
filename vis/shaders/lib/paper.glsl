// Paper texture of the whole picture: grain lit from the upper left, and slightly uneven pulp. It covers objects too,
// so that blank areas of an object match the paper beside it. Twin: vis/optics/grain.h.

// Factor on linear light, 1 on average; `at` in texels of the tile, `tooth` (depth of the grain) 0..1.
float paperShade(sampler2D tile, vec2 at, float tooth) {
    float edge = float(textureSize(tile, 0).x);
    float here = textureLod(tile, at / edge, 0.0).r, there = textureLod(tile, (at + vec2(-1.5, 1.5)) / edge, 0.0).r;
    float pulp = textureLod(tile, at / (7.3 * edge), 0.0).r - 0.5;
    return 1.0 + tooth * (0.1 * (here - there) + 0.05 * pulp);
}
