// Applies the looks of layers. LAYER_LOOK(i): bits of LookFeature (vis/gl/shader_constants.h) of layer i; LOOKS: their
// union over all layers.
#include "lib/shading/look.glsl"
#include "lib/shading/grain.glsl"

#define LOOK_OUTLINE (LOOK_CARTOON | LOOK_CHARCOAL)

uniform vec4 lookLight;   // first light: direction towards it, w = 0; or position, w = 1
uniform vec2 lookDepth;   // view distance of depth 0; depth per world unit
uniform vec2 lookPixel;   // world edge of a pixel: x + y * distance along the ray
uniform vec3 lookSmooth[LAYERS]; // of normals: reach in cells, scale; world distance that curvature is measured over
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
uniform vec4 lookRim[LAYERS]; // colour of the ink, its share
#endif
#if (LOOKS & LOOK_DISTANCE)
uniform vec4 lookDistance[LAYERS]; // colour, amount
uniform float lookDistanceExponent[LAYERS];
#endif
#if (LOOKS & LOOK_CARTOON)
uniform vec4 lookCartoon[LAYERS];  // amount, steps, shadow; 1 if outlines have their own colour
uniform vec4 lookOutline[LAYERS];  // that colour, or the ink on the ground; width in pixels
uniform vec3 lookDarkInk, lookLightInk;
#endif
#if (LOOKS & LOOK_CHARCOAL)
uniform vec3 lookStick[LAYERS]; // colour
uniform vec3 lookLine[LAYERS]; // see charcoalInk()
uniform vec4 lookTone[LAYERS], lookMark[LAYERS];
uniform vec4 lookGrain[LAYERS]; // texel in pixels, turn of strokes in radians, local tone, how much curvature directs them
uniform vec2 lookLayers[LAYERS];
uniform sampler2D grainTile;

// Tooth, strokes, crossing strokes and dots, those that show at a density of ink.
vec4 marksAt(int i, LookSample at, vec2 density) {
    float size = lookGrain[i].x * at.pixel;
    bool needed = density.x * at.share > 0.0;
    vec2 grain = grainAt(grainTile, at.world, at.normal, size, needed || density.y * at.share > 0.0);
    vec4 marks = vec4(grain.x, 0.5, 0.5, grain.y);
    if ((LAYER_LOOK(i) & LOOK_DOTS) == 0) {
        vec3 along = strokeDirection(at.normal, at.bend, lookGrain[i].w, lookGrain[i].y);
        marks.y = strokesAt(grainTile, at.world, at.normal, along, size, 0.0, needed);
#if (LOOKS & LOOK_CROSS)
        if ((LAYER_LOOK(i) & LOOK_CROSS) != 0)
            marks.z = strokesAt(grainTile, at.world, at.normal, cross(at.normal, along), size, kCrossingShift,
                                needed && density.x > lookLayers[i].x);
#endif
    }
    return marks;
}
#endif
#if (LOOKS & LOOK_WIRE)
uniform vec4 lookWire[LAYERS];      // spacing in world units, width in pixels, retained, own colour
uniform vec3 lookWireColor[LAYERS];
#endif

float solidOpacity(int i, float opacity, float doi) {
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0)
        return mix(opacity, smoothstep(0.03, 0.4, opacity), lookShare[i].x + lookShare[i].y * doi);
#endif
    return opacity;
}

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
        return mix(albedo, mix(vec3(1.0), albedo, lookGrain[i].z), at.share);
#endif
    return albedo;
}

vec3 lookColor(int i, vec3 albedo, vec3 lit, LookSample at) {
    vec3 color = lit;
    float light = at.light;
#if (LOOKS & LOOK_CARTOON)
    if ((LAYER_LOOK(i) & LOOK_CARTOON) != 0) {
        light = lightStep(light, int(lookCartoon[i].y));
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
    {
        float width = lookOutline[i].a * at.pixel, amount = lookCartoon[i].x * at.weight * at.share;
        vec3 inner = lookCartoon[i].w > 0.5 ? lookOutline[i].rgb : inkOn(albedo, lookDarkInk, lookLightInk);
        float line = max(outline(at.facing, at.curvature, width), cutLine(at.cut, lookOutline[i].a));
        float outer = max(outline(at.facing, at.curvature, 0.5 * width), cutLine(at.cut, 0.5 * lookOutline[i].a));
        color = mix(color, inner, amount * line);
        color = mix(color, lookOutline[i].rgb, amount * outer);
    }
#endif
#if (LOOKS & LOOK_SILHOUETTE)
    if ((LAYER_LOOK(i) & LOOK_SILHOUETTE) != 0)
        color = mix(color, lookRim[i].rgb,
                    lookRim[i].a * turnedAway(lookSilhouette[i].z, at) * at.weight * at.share);
#endif
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0) {
        vec2 density = charcoalDensity(lit, at, lookTone[i], lookLine[i], lookMark[i].w);
        float ink = charcoalInk(density, marksAt(i, at, density), lookMark[i], lookLayers[i],
                                (LAYER_LOOK(i) & LOOK_DOTS) != 0);
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
