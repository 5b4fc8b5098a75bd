// What everything lit and cut knows of the scene, rays and rasterised layers.

uniform vec3 halfSize; // of the box, world

// Light (vis/scene/lighting.h): LIGHTS = 0, 1, 2 or the cap; POINT_LIGHTS = 0 where none of them is near.
uniform int lightCount;
#if LIGHTS > 0
uniform vec4 lightPlace[LIGHTS]; // direction towards it, 0; or position, 1
uniform vec3 lightColor[LIGHTS]; // linear, times intensity
#else
const vec4 lightPlace[1] = vec4[1](vec4(0.0));
const vec3 lightColor[1] = vec3[1](vec3(0.0));
#endif
// LIGHT_MAPS: 1 with cube maps. LIGHT_VOLUME: 1 with shadows or occlusion, 2 with translucency too.
#if LIGHT_MAPS
uniform samplerCube diffuseMap, specularMap;
uniform mat3 mapFromWorld;
uniform vec2 mapShare; // of Phong: diffuse, specular
#endif
#if LIGHT_VOLUME
uniform sampler3D lightVisible; // of lights 0 to 2, of light from everywhere
uniform vec2 shadowStrength;    // of shadows, of occlusion
uniform vec4 flatShares;        // FlatShares of vis/optics/shade.h: lights, everywhere
uniform float lightCell;        // longest edge of a cell, world
#if LIGHT_VOLUME == 2
uniform sampler3D lightScattered;
#endif
#endif
uniform vec4 material; // ambient; then diffuse, specular, shininess, or roughness, metalness, reflectance

// Clips (vis/scene/clipping.h): CLIPS of them; CLIP_KIND(i), CLIP_HOLE(i); CLIP_HOLES: 1 if one of them is a hole.
#if CLIPS > 0
uniform vec3 clipCenter[CLIPS], clipAxis[CLIPS], clipHalf[CLIPS];
#endif
