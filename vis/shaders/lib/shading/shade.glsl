// Lighting of a sample with the uniforms of lib/bindings/light_bindings.glsl. Formulas in the twin: vis/optics/shade.h.
#include "lib/sampling/filtered.glsl"

#if LIGHT_VOLUME
// Transmitted fractions of the lights at a world point, and scattered light.
void reachingLight(vec3 world, out vec4 shares, out vec3 scattered) {
    vec3 at = 0.5 + 0.5 * world / halfSize;
    shares = mix(vec4(1.0), filtered(lightVisible, at), shadowStrength.xxxy);
    scattered = vec3(0.0);
#if LIGHT_VOLUME == 2
    scattered = filtered(lightScattered, at).rgb;
#endif
}

vec3 flatColor(vec3 albedo, vec4 shares, vec3 scattered) {
    return albedo * (dot(flatShares, shares) + 1.0 - dot(flatShares, vec4(1.0)) + scattered);
}
#endif

// A sample without a surface.
vec3 shadeFlat(vec3 albedo, vec3 place) {
#if LIGHT_VOLUME
    vec4 shares;
    vec3 scattered;
    reachingLight(place, shares, scattered);
    return flatColor(albedo, shares, scattered);
#else
    return albedo;
#endif
}

vec3 shade(vec3 albedo, vec3 gradient, float weight, vec3 place, vec3 toViewer) {
    if (!(dot(gradient, gradient) > 0.0)) return shadeFlat(albedo, place);
    Facing at = facing(gradient, toViewer);
    vec3 diffuse, specular;
    evenLight(at, albedo, diffuse, specular);
    vec3 around = material.x * (diffuse + specular);
#if LIGHT_MAPS
    vec3 normal = mapFromWorld * at.normal;
    vec3 mirrored = mapFromWorld * reflect(-toViewer, at.normal);
    vec3 fromAround = mix(textureLod(diffuseMap, -normal, 0.0).rgb, textureLod(diffuseMap, normal, 0.0).rgb, at.front);
    around += mapDiffuse(diffuse) * fromAround + mapSpecular(specular) * textureLod(specularMap, mirrored, 0.0).rgb;
#endif
#if LIGHT_VOLUME
    vec4 shares;
    vec3 scattered;
    reachingLight(place + at.normal * (1.5 * (2.0 * at.front - 1.0) * weight * lightCell), shares, scattered);
    vec3 without = flatColor(albedo, shares, scattered);
    vec3 lit = shares.w * around + albedo * scattered;
#else
    vec3 without = albedo;
    vec3 lit = around;
#endif
    // One or two lights are unrolled; any larger number uses the same program.
    for (int i = 0; i < (LIGHTS <= 2 ? LIGHTS : lightCount); ++i) {
#if POINT_LIGHTS
        vec3 way = lightPlace[i].xyz - place * lightPlace[i].w;
        float squared = dot(way, way);
        float falloff = lightPlace[i].w > 0.5 ? 1.0 / max(squared, 1e-4) : 1.0;
        vec3 toLight = way * inversesqrt(max(squared, 1e-12));
#else
        float falloff = 1.0;
        vec3 toLight = lightPlace[i].xyz;
#endif
#if LIGHT_VOLUME
        falloff *= i == 0 ? shares.x : i == 1 ? shares.y : i == 2 ? shares.z : 1.0;
#endif
        lit += lightColor[i] * falloff * surfaceLight(at, albedo, diffuse, toLight);
    }
    return mix(without, lit, weight);
}
