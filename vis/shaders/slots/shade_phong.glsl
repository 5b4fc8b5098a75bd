// Slot shade: Phong reflection model.
#include "lib/shading/lighting.glsl"

vec3 surfaceLight(Facing at, vec3 albedo, vec3 even, vec3 toLight) {
    return phongLight(at, albedo, toLight, material);
}

#if LIGHT_MAPS
vec3 mapDiffuse(vec3 diffuse) {
    return diffuse * mapShare.x;
}
vec3 mapSpecular(vec3 specular) {
    return vec3(mapShare.y);
}
#endif

void evenLight(Facing at, vec3 albedo, out vec3 diffuse, out vec3 specular) {
    diffuse = albedo;
    specular = vec3(0.0);
}
