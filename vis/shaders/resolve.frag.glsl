// The final picture: background or paper, edges of the box behind, the ray caster's colour, edges in front; encoded to
// sRGB at the end. Features are compiled in, since software GL would execute all of them for every pixel: BLUR,
// DEPTH_MASK, LINES,
// WHOLE (each pixel has one of its own in the source: reading one texel instead of mixing four saves software GL 5 ns a
// pixel), TONE, PAPER, GROUND (0: output opacity and straight colour instead of blending with the ground), each 0 or 1.
#include "lib/layers/color.glsl"

uniform sampler2D source;      // linear, premultiplied
uniform vec2 sourceScale;      // texture coordinate = sourceFirst + gl_FragCoord * sourceScale, at most sourceLimit
uniform vec2 sourceFirst, sourceLimit;
uniform vec3 background;       // linear
#if PAPER
#include "lib/shading/paper.glsl"
uniform sampler2D grainTile;
uniform vec2 paper;            // depth of its grain, texels per pixel
#endif
#if LINES
uniform vec3 boxColor;         // linear
uniform int edgeCount;
uniform vec4 edges[12];        // end points in pixels; the last `frontCount` lie in front of the volume
uniform int frontCount;
uniform float lineWidth;       // pixels
#endif
#if TONE
#include "lib/shading/tone.glsl"
uniform int toneCurve;
uniform vec2 tone;             // gain, white
#endif

#if BLUR || DEPTH_MASK
uniform sampler2D seen;   // distance and degree of interest
#endif
#if BLUR
#include "formulas/context_blur.glsl"
uniform float blurRadius; // pixels
uniform int blurTaps;     // kBlurTaps; a uniform, so that the loop is not unrolled
#endif

#if DEPTH_MASK
#include "formulas/depth_mask.glsl"
uniform vec2 depthSpan;    // near, per distance
uniform float depthRadius; // pixels
uniform vec2 depthMask;    // strength, 1: lightens too
uniform int depthTaps;     // kDepthTaps; a uniform, so that the loop is not unrolled
#endif

out vec4 outColor;

// Half a texel from the edges of what is used: texels beside it hold other pictures.
vec2 place(vec2 pixel) {
    return clamp(sourceFirst + pixel * sourceScale, sourceFirst + 0.5 / vec2(textureSize(source, 0)), sourceLimit);
}

// Colour of a pixel before the background, with unselected samples blurred.
vec4 picture(vec2 pixel) {
#if WHOLE
    vec4 own = texelFetch(source, ivec2(pixel), 0);
#else
    vec4 own = textureLod(source, place(pixel), 0.0);
#endif
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

#if DEPTH_MASK
float depthAt(vec2 pixel) {
    return pixelDepth(textureLod(seen, place(pixel), 0.0).x, depthSpan);
}

// Mean depth around a pixel less its own, itself a mean over the pixels that touch it: the edges of surfaces are
// jagged in the depths.
float depthDifference(vec2 pixel) {
    float sum = 0.0, weight = 0.0, own = 0.0;
    for (int i = 0; i < depthTaps; ++i) {
        sum += depthTapWeight(i) * depthAt(pixel + depthTap(i) * depthRadius);
        weight += depthTapWeight(i);
    }
    for (int i = 0; i < 9; ++i) own += depthAt(pixel + vec2(float(i % 3 - 1), float(i / 3 - 1))) / 9.0;
    return sum / weight - own;
}
#endif

#if LINES
// Coverage of the pixel by lines first .. last - 1.
float lines(int first, int last) {
    float covered = 0.0;
    for (int i = first; i < last; ++i) {
        vec2 a = edges[i].xy, along = edges[i].zw - a, to = gl_FragCoord.xy - a;
        float t = clamp(dot(to, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
        covered = max(covered, clamp(0.5 * lineWidth + 0.5 - length(to - t * along), 0.0, 1.0));
    }
    return covered;
}
#endif

void main() {
    vec4 volume = picture(gl_FragCoord.xy);
#if DEPTH_MASK
    volume = maskedByDepth(volume, depthDifference(gl_FragCoord.xy), depthMask.x, depthMask.y);
#endif
#if TONE
    volume.rgb = toneMap(volume.rgb / max(volume.a, 1e-6), toneCurve, tone.x, tone.y) * volume.a;
#endif
#if LINES
    float behind = lines(0, edgeCount - frontCount), before = lines(edgeCount - frontCount, edgeCount);
#endif
#if GROUND
    vec3 color = background;
#if LINES
    color = mix(color, boxColor, behind);
#endif
    color = volume.rgb + (1.0 - volume.a) * color;
#if PAPER
    color *= paperShade(grainTile, gl_FragCoord.xy * paper.y, paper.x);
#endif
#if LINES
    color = mix(color, boxColor, before);
#endif
    outColor = vec4(srgbFromLinear(color), 1.0);
#else
#if LINES
    // Lines behind are seen through the volume.
    volume += (1.0 - volume.a) * vec4(boxColor * behind, behind);
    volume = mix(volume, vec4(boxColor, 1.0), before);
#endif
    outColor = vec4(srgbFromLinear(volume.rgb / max(volume.a, 1e-6)), volume.a);
#endif
}
