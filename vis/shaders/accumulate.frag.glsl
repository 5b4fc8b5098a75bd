// Adds one pass to a supersampled frame. The blend colour is the weight of the pass.
uniform sampler2D source, sourceReach;

layout(location = 0) out vec4 outColor;
layout(location = 2) out float outReach;

void main() {
    outColor = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    outReach = texelFetch(sourceReach, ivec2(gl_FragCoord.xy), 0).r;
}
