// Paper texture of the whole picture: grain lit from the upper left, and slightly uneven pulp. It covers objects too,
// so that blank areas of an object match the paper beside it. Twin: vis/optics/grain.h.
#include "lib/sampling/filtered.glsl"

// Factor on linear light, 1 on average; `at` in texels of the tile, `tooth` (depth of the grain) 0..1.
float paperShade(sampler2D tile, vec2 at, float tooth) {
    float here = filteredTile(tile, at).r, there = filteredTile(tile, at + vec2(-1.5, 1.5)).r;
    float pulp = filteredTile(tile, at / 7.3).r - 0.5;
    return 1.0 + tooth * (0.1 * (here - there) + 0.05 * pulp);
}
