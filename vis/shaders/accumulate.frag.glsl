// One more pass of a supersampled still: its share is the blend colour's.
uniform sampler2D source, sourceReach;

layout(location = 0) out vec4 outColor;
layout(location = 2) out float outReach;

void main() {
    outColor = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    outReach = texelFetch(sourceReach, ivec2(gl_FragCoord.xy), 0).r;
}
