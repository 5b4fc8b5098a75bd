// How far a ray goes through the grid of blocks that ranges of values are known of.
uniform vec3 blockScale, blockOffset; // block coordinate = p * scale + offset

// Of this ray, since software GL computes in every round of a loop what stands in it: samples per block and axis, and
// where the far wall of a block is.
vec3 samplesPerBlock, farWall;
vec3 blockPlace[2]; // scale and offset, see lib/kept.glsl

void beginBlocks(vec3 cellsPerSample) {
    blockPlace[0] = blockScale;
    blockPlace[1] = blockOffset;
    vec3 step = cellsPerSample * blockPlace[0];
    farWall = vec3(greaterThan(step, vec3(0.0)));
    samplesPerBlock = 1.0 / mix(min(step, -1e-9), max(step, 1e-9), farWall);
}

// Samples from a place within a block (0..1) up to the walls of the cube of blocks that lie closer than `reach` blocks;
// the one at that place counts.
int samplesToWall(vec3 place, float reach) {
    vec3 steps = (farWall + (2.0 * farWall - 1.0) * (reach - 1.0) - place) * samplesPerBlock;
    return max(1, int(floor(min(min(min(steps.x, steps.y), steps.z), 1e6) - 0.01)) + 1);
}
