// Applies the looks of layers. LAYER_LOOK(i): bits of LookFeature (vis/gl/shader_constants.h) of layer i; LOOKS: their
// union over all layers.
#include "lib/look.glsl"
#include "lib/grain.glsl"

#define LOOK_OUTLINE (LOOK_CARTOON | LOOK_CHARCOAL)

uniform vec4 lookLight;   // first light: direction towards it, w = 0; or position, w = 1
uniform vec2 lookDepth;   // view distance of depth 0; depth per world unit
uniform vec2 lookPixel;   // world edge of a pixel: x + y * distance along the ray
uniform float lookReach;  // world distance over which curvature is measured
uniform vec3 lookGround;  // colour of the paper or background
uniform vec2 lookShare[LAYERS]; // share of the look = x + y * degree of interest
#if (LOOKS & LOOK_TONE)
uniform vec4 lookWarm[LAYERS], lookCool[LAYERS]; // colour; amount; share of the own colour
#endif
#if (LOOKS & LOOK_BOUNDARY)
uniform vec3 lookBoundary[LAYERS];
#endif
#if (LOOKS & LOOK_SILHOUETTE)
uniform vec3 lookSilhouette[LAYERS];
#endif
#if (LOOKS & LOOK_DISTANCE)
uniform vec4 lookDistance[LAYERS]; // colour, amount
uniform float lookDistanceExponent[LAYERS];
#endif
#if (LOOKS & LOOK_CARTOON)
uniform vec3 lookCartoon[LAYERS];  // amount, steps, shadow
uniform vec4 lookOutline[LAYERS];  // colour; width in pixels
#endif
#if (LOOKS & LOOK_CHARCOAL)
uniform vec3 lookStick[LAYERS]; // colour
uniform vec3 lookTone[LAYERS], lookLine[LAYERS]; // see charcoalInk()
uniform vec4 lookMark[LAYERS];
uniform vec4 lookGrain[LAYERS];                                    // texel in pixels, rotation, local tone
uniform sampler2D grainTile;
#endif
#if (LOOKS & LOOK_WIRE)
uniform vec4 lookWire[LAYERS];      // spacing in world units, width in pixels, retained, own colour
uniform vec3 lookWireColor[LAYERS];
#endif

float lookOpacity(int i, float opacity, LookSample at) {
    float factor = 1.0;
#if (LOOKS & LOOK_BOUNDARY)
    if ((LAYER_LOOK(i) & LOOK_BOUNDARY) != 0) factor *= boundaryFactor(lookBoundary[i], at);
#endif
#if (LOOKS & LOOK_SILHOUETTE)
    if ((LAYER_LOOK(i) & LOOK_SILHOUETTE) != 0) factor *= silhouetteFactor(lookSilhouette[i], at);
#endif
#if (LOOKS & LOOK_WIRE)
    if ((LAYER_LOOK(i) & LOOK_WIRE) != 0) factor *= mix(lookWire[i].z, 1.0, at.wire);
#endif
    return min(1.0, opacity * mix(1.0, factor, at.share));
}

vec3 lookAlbedo(int i, vec3 albedo, LookSample at) {
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0)
        return mix(albedo, mix(vec3(1.0), albedo, lookGrain[i].w), at.share);
#endif
    return albedo;
}

vec3 lookColor(int i, vec3 albedo, vec3 lit, LookSample at) {
    vec3 color = lit;
    float light = at.light;
#if (LOOKS & LOOK_CARTOON)
    if ((LAYER_LOOK(i) & LOOK_CARTOON) != 0) {
        light = lightStep(light, lookCartoon[i].y);
        color = mix(color, albedo * mix(lookCartoon[i].z, 1.0, light), lookCartoon[i].x * at.weight * at.share);
    }
#endif
#if (LOOKS & LOOK_TONE)
    if ((LAYER_LOOK(i) & LOOK_TONE) != 0)
        color = mix(color, toned(albedo, light, lookWarm[i].rgb, lookCool[i].rgb, lookCool[i].a),
                    lookWarm[i].a * at.weight * at.share);
#endif
#if (LOOKS & LOOK_CARTOON)
    if ((LAYER_LOOK(i) & LOOK_CARTOON) != 0)
        color = mix(color, lookOutline[i].rgb, outline(at.facing, at.curvature, lookOutline[i].a * at.pixel) *
                                                   lookCartoon[i].x * at.weight * at.share);
#endif
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0) {
        float ink = charcoalInk(lit, at, lookTone[i], lookLine[i], lookMark[i]);
        color = mix(color, mix(lookGround, lookStick[i], ink), at.share);
    }
#endif
#if (LOOKS & LOOK_WIRE)
    if ((LAYER_LOOK(i) & LOOK_WIRE) != 0)
        color = mix(color, mix(lookWireColor[i], color, lookWire[i].w), at.wire * at.share);
#endif
#if (LOOKS & LOOK_DISTANCE)
    if ((LAYER_LOOK(i) & LOOK_DISTANCE) != 0)
        color = mix(color, lookDistance[i].rgb,
                    lookDistance[i].a * pow(max(at.depth, 1e-6), lookDistanceExponent[i]) * at.share);
#endif
    return color;
}
