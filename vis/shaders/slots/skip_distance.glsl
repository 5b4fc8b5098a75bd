// Slot skip: Chebyshev distance to the nearest block that can contribute, in blocks.
#define SKIPPING 1
#include "lib/block_walls.glsl"
uniform usampler3D blockDistance;

// Samples from p on (the one at p among them) that lie in empty blocks.
int emptySamples(vec3 p) {
    vec3 q = p * blockPlace[0] + blockPlace[1], block = floor(q);
    ivec3 at = clamp(ivec3(block), ivec3(0), textureSize(blockDistance, 0) - 1);
    // Blocks closer than `reach` are empty: the region from block - (reach - 1) to block + reach.
    float reach = float(texelFetch(blockDistance, at, 0).r);
    return reach < 0.5 ? 0 : samplesToWall(q - block, reach);
}
