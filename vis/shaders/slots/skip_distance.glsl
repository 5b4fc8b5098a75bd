// Slot skip: empty-space skipping by the Chebyshev distance, in blocks, to the nearest block that can contribute. With
// ADAPTIVE, values above 128 mark a contributing block and encode its step length (vis/optics/adaptive_step.h).
#define SKIPPING 1
#include "lib/sampling/block_walls.glsl"
uniform usampler3D blockDistance;

// Number of samples from p on, including the one at p, that lie in empty blocks.
int emptySamples(vec3 p) {
    vec3 q = p * blockPlace[0] + blockPlace[1], block = floor(q);
    ivec3 at = clamp(ivec3(block), ivec3(0), textureSize(blockDistance, 0) - 1);
    // All blocks closer than `reach` are empty: from block - (reach - 1) to block + reach.
    float reach = float(texelFetch(blockDistance, at, 0).r);
#ifdef ADAPTIVE
    if (reach > 127.5) reach = 0.0;
#endif
    return reach < 0.5 ? 0 : samplesToWall(q - block, reach);
}

#ifdef ADAPTIVE
uniform float stepUnit;

// Number of samples from p on, including the one at p, that a single sample in their middle may represent.
int samplesTogether(vec3 p, float stepLength) {
    vec3 q = p * blockPlace[0] + blockPlace[1], block = floor(q);
    ivec3 at = clamp(ivec3(block), ivec3(0), textureSize(blockDistance, 0) - 1);
    float code = float(texelFetch(blockDistance, at, 0).r) - 128.0;
    float most = stepUnit * exp2(code * 0.125) / stepLength;
    return code < 0.5 ? 1 : clamp(int(min(most, 1e3)), 1, samplesToWall(q - block, 1.0));
}
#endif
