// The largest termination depth over a tile of pixels (REACH in raycast.frag.glsl).
uniform sampler2D termination;
uniform vec2 first, size; // of the picture within the buffer, in pixels

out float farthest;

void main() {
    ivec2 from = ivec2(gl_FragCoord.xy) * TILE;
    farthest = -1e9;
    for (int y = 0; y < TILE; ++y)
        for (int x = 0; x < TILE; ++x) {
            ivec2 at = ivec2(first) + min(from + ivec2(x, y), ivec2(size) - 1);
            farthest = max(farthest, texelFetch(termination, at, 0).r);
        }
}
