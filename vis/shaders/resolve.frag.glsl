// The picture as shown: background or paper, wire box behind, the ray caster's colour, wire box in front; linear light encoded
// to sRGB at the end.
#include "lib/color.glsl"
#include "lib/tone.glsl"
#include "lib/paper.glsl"

uniform sampler2D source;      // linear, premultiplied
uniform vec2 sourceScale;      // texture coordinate = gl_FragCoord * sourceScale, at most sourceLimit
uniform vec2 sourceLimit;
uniform vec3 background;       // linear
uniform sampler2D grainTile;   // of paper
uniform vec2 paper;            // how much its tooth shows, texels per pixel; 0: none
uniform int showGround;        // 0: opacity and straight colour instead
uniform vec3 boxColor;         // linear
uniform int edgeCount;
uniform vec4 edges[12];        // ends in pixels; the last `frontCount` of them lie in front of the volume
uniform int frontCount;
uniform float lineWidth;       // pixels
uniform int toneCurve;
uniform vec2 tone;              // gain, white

#if BLUR
#include "lib/context_blur.glsl"
uniform sampler2D seen;   // distance and degree of interest
uniform float blurRadius; // pixels
uniform int blurTaps;     // kBlurTaps, no constant: not unrolled
#endif

out vec4 outColor;

vec2 place(vec2 pixel) {
    return clamp(pixel * sourceScale, vec2(0.0), sourceLimit);
}

// What a pixel shows before the background: what is not brushed is out of focus.
vec4 picture(vec2 pixel) {
    vec4 own = textureLod(source, place(pixel), 0.0);
#if BLUR
    float doi = textureLod(seen, place(pixel), 0.0).y;
    vec4 sum = own;
    float weight = 1.0;
    for (int i = 0; i < (doi < 1.0 ? blurTaps : 0); ++i) {
        vec2 offset = blurTap(i) * blurRadius, at = place(pixel + offset);
        float share = blurShare(textureLod(seen, at, 0.0).y, length(offset), blurRadius);
        sum += share * textureLod(source, at, 0.0);
        weight += share;
    }
    own = mix(sum / weight, own, doi);
#endif
    return own;
}

// Share of the pixel that lines first .. last - 1 cover.
float lines(int first, int last) {
    float covered = 0.0;
    for (int i = first; i < last; ++i) {
        vec2 a = edges[i].xy, along = edges[i].zw - a, to = gl_FragCoord.xy - a;
        float t = clamp(dot(to, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
        covered = max(covered, clamp(0.5 * lineWidth + 0.5 - length(to - t * along), 0.0, 1.0));
    }
    return covered;
}

void main() {
    vec4 volume = picture(gl_FragCoord.xy);
    float behind = edgeCount > 0 ? lines(0, edgeCount - frontCount) : 0.0;
    float before = edgeCount > 0 ? lines(edgeCount - frontCount, edgeCount) : 0.0;
    vec3 color = mix(background, boxColor, behind);
    vec3 shown = toneMap(volume.rgb / max(volume.a, 1e-6), toneCurve, tone.x, tone.y) * volume.a;
    color = (toneCurve == 0 ? volume.rgb : shown) + (1.0 - volume.a) * color;
    if (paper.x > 0.0) color *= paperShade(grainTile, gl_FragCoord.xy * paper.y, paper.x);
    color = mix(color, boxColor, before);
    outColor = vec4(srgbFromLinear(color), 1.0);
    if (showGround == 0) {
        // A line behind is seen through what is before it.
        vec4 over = vec4(toneCurve == 0 ? volume.rgb : shown, volume.a);
        over += (1.0 - over.a) * vec4(boxColor * behind, behind);
        over = mix(over, vec4(boxColor, 1.0), before);
        outColor = vec4(srgbFromLinear(over.rgb / max(over.a, 1e-6)), over.a);
    }
}
