// Slot shade: GGX specular over a Lambertian base.
#include "lib/shading/lighting.glsl"

vec3 surfaceLight(Facing at, vec3 albedo, vec3 even, vec3 toLight) {
    return physicalLight(at, albedo, even, toLight, material);
}

#if LIGHT_MAPS
vec3 mapDiffuse(vec3 diffuse) {
    return diffuse;
}
vec3 mapSpecular(vec3 specular) {
    return specular;
}
#endif

void evenLight(Facing at, vec3 albedo, out vec3 diffuse, out vec3 specular) {
    physicalEvenLight(at, albedo, material, diffuse, specular);
}
