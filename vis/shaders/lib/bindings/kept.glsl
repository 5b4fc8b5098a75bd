// Software GL (Mesa 22.3) loads a uniform per lane at every use and in every loop iteration. keepUniforms() copies
// those used in loops to variables once per pixel. (All copies are elements of arrays, copied one by one: otherwise the
// compiler recognises copies of uniforms and reads the uniforms again.)

vec3 keptScale[FIELDS], keptOffset[FIELDS], keptOdd[FIELDS], keptInverse[FIELDS];
int keptLevel[FIELDS];
vec3 keptVectors[3];
float keptNumbers[3];
vec4 keptMaterial[1];
#if LAYERS > 0
vec4 keptMap[LAYERS];
vec3 keptColor[LAYERS];
vec2 keptMore[LAYERS], keptOpaque[LAYERS];
#if COLORED
vec2 keptColorMap[LAYERS];
#endif
#endif
#if LIGHTS > 0 && LIGHTS <= 2
vec4 keptPlace[LIGHTS];
vec3 keptLight[LIGHTS];
#endif

void keepUniforms() {
    for (int i = 0; i < FIELDS; ++i) {
        keptScale[i] = fieldScale[i];
        keptOffset[i] = fieldOffset[i];
        keptOdd[i] = fieldOdd[i];
        keptInverse[i] = atlasInverse[i];
        keptLevel[i] = fieldLevel[i];
    }
    keptVectors[0] = worldCell;
    keptVectors[1] = cellsPerWorld;
    keptVectors[2] = cellsOffset;
    keptNumbers[0] = gradientReach;
    keptNumbers[1] = gradientScale;
    keptNumbers[2] = levelPhase;
    keptMaterial[0] = material;
#if LAYERS > 0
    for (int i = 0; i < LAYERS; ++i) {
        keptMap[i] = layerMap[i];
        keptColor[i] = layerColor[i];
        keptMore[i] = layerMore[i];
        keptOpaque[i] = layerOpaque[i];
#if COLORED
        keptColorMap[i] = layerColorMap[i];
#endif
    }
#endif
#if LIGHTS > 0 && LIGHTS <= 2
    for (int i = 0; i < LIGHTS; ++i) {
        keptPlace[i] = lightPlace[i];
        keptLight[i] = lightColor[i];
    }
#endif
}

#define fieldScale keptScale
#define fieldOffset keptOffset
#define fieldOdd keptOdd
#define atlasInverse keptInverse
#define fieldLevel keptLevel
#define worldCell keptVectors[0]
#define cellsPerWorld keptVectors[1]
#define cellsOffset keptVectors[2]
#define gradientReach keptNumbers[0]
#define gradientScale keptNumbers[1]
#define levelPhase keptNumbers[2]
#define material keptMaterial[0]
#if LAYERS > 0
#define layerMap keptMap
#define layerColor keptColor
#define layerMore keptMore
#define layerOpaque keptOpaque
#define layerColorMap keptColorMap
#endif
#if LIGHTS > 0 && LIGHTS <= 2
#define lightPlace keptPlace
#define lightColor keptLight
#endif
