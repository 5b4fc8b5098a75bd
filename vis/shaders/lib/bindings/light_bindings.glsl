// Uniforms for lighting and clipping, shared by rays and rasterised layers.

uniform vec3 halfSize; // half edges of the box, world

// Lights (vis/scene/lighting.h). LIGHTS: 0, 1, 2 or the maximum; POINT_LIGHTS: 0 if all lights are directional.
uniform int lightCount;
#if LIGHTS > 0
uniform vec4 lightPlace[LIGHTS]; // direction towards it, 0; or position, 1
uniform vec3 lightColor[LIGHTS]; // linear, times intensity
#else
const vec4 lightPlace[1] = vec4[1](vec4(0.0));
const vec3 lightColor[1] = vec3[1](vec3(0.0));
#endif
// LIGHT_MAPS: 1 with cube maps. LIGHT_VOLUME: 1 with shadows or ambient occlusion, 2 with translucency too.
#if LIGHT_MAPS
uniform samplerCube diffuseMap, specularMap;
uniform mat3 mapFromWorld;
uniform vec2 mapShare; // of Phong: diffuse, specular
#endif
#if LIGHT_VOLUME
uniform sampler3D lightVisible; // transmitted fraction of lights 0 to 2 and of ambient light
uniform vec2 shadowStrength;    // of shadows, of ambient occlusion
uniform vec4 flatShares;        // FlatShares of vis/optics/shade.h: lights, ambient
uniform float lightCell;        // longest edge of a light volume cell, world
#if LIGHT_VOLUME == 2
uniform sampler3D lightScattered;
#endif
#endif
uniform vec4 material; // ambient; then diffuse, specular, shininess, or roughness, metalness, reflectance

// Clips (vis/scene/clipping.h). CLIPS: their number; CLIP_KIND(i), CLIP_HOLE(i); CLIP_HOLES: 1 if one is a hole.
#if CLIPS > 0
uniform vec3 clipCenter[CLIPS], clipAxis[CLIPS], clipHalf[CLIPS];
#endif
