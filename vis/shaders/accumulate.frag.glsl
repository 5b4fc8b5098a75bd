// Adds one pass to a supersampled frame. The blend colour is the weight of the pass.
uniform sampler2D source, sourceTermination;

layout(location = 0) out vec4 outColor;
layout(location = 2) out float outTermination;

void main() {
    outColor = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
    outTermination = texelFetch(sourceTermination, ivec2(gl_FragCoord.xy), 0).r;
}
