// Slot skip: Chebyshev distance to the nearest block that can contribute, in blocks.
#define SKIPPING 1
uniform usampler3D blockDistance;
uniform vec3 blockScale, blockOffset; // block coordinate = p * scale + offset

// Samples that can be passed over from p, the next one still inside the empty region; 0 when there are none.
int emptySamples(vec3 p, vec3 cellsPerSample) {
    vec3 q = p * blockScale + blockOffset, dq = cellsPerSample * blockScale;
    vec3 block = floor(q);
    ivec3 at = clamp(ivec3(block), ivec3(0), textureSize(blockDistance, 0) - 1);
    float reach = float(texelFetch(blockDistance, at, 0).r);
    // Blocks closer than `reach` are empty: the region from block - (reach - 1) to block + reach.
    vec3 wall = mix(block - reach + 1.0, block + reach, greaterThan(dq, vec3(0.0)));
    vec3 steps = (wall - q) / mix(dq, vec3(1e-9), lessThan(abs(dq), vec3(1e-9)));
    steps = mix(steps, vec3(1e6), lessThan(abs(dq), vec3(1e-9)));
    return reach < 0.5 ? 0 : max(0, int(floor(min(min(steps.x, steps.y), steps.z) - 0.01)));
}
