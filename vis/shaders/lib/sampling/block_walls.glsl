// Traversal of the block grid for empty-space skipping.
uniform vec3 blockScale, blockOffset; // block coordinate = p * scale + offset

// Loop invariants of the ray, hoisted since software GL does not: samples per block and axis, and the position of a
// block's exit wall.
vec3 samplesPerBlock, farWall;
vec3 blockPlace[2]; // copies of scale and offset, see lib/bindings/kept.glsl

void beginBlocks(vec3 cellsPerSample) {
    blockPlace[0] = blockScale;
    blockPlace[1] = blockOffset;
    vec3 step = cellsPerSample * blockPlace[0];
    farWall = vec3(greaterThan(step, vec3(0.0)));
    samplesPerBlock = 1.0 / mix(min(step, -1e-9), max(step, 1e-9), farWall);
}

// Number of samples from a position within a block (0..1) to the exit from the cube of blocks closer than `reach`
// blocks, including the sample at that position.
int samplesToWall(vec3 place, float reach) {
    vec3 steps = (farWall + (2.0 * farWall - 1.0) * (reach - 1.0) - place) * samplesPerBlock;
    return max(1, int(floor(min(min(min(steps.x, steps.y), steps.z), 1e6) - 0.01)) + 1);
}
