// One more pass of a supersampled still: its share is the blend colour's.
uniform sampler2D source;

out vec4 outColor;

void main() {
    outColor = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
