// World and cells, and the place in the data that is seen at a place of the picture. Comes after the slot reconstruct:
// what is read after it goes through the lenses that magnify.
#include "lib/lenses.glsl"

vec3 toCells(vec3 world) {
    return world * cellsPerWorld + cellsOffset;
}
vec3 fromCells(vec3 p) {
    return (p - cellsOffset) / cellsPerWorld;
}

vec3 dataCells(vec3 p) {
#if LENS_BENDS
    return toCells(lensBend(fromCells(p)));
#else
    return p;
#endif
}
#if LENS_BENDS
#define reconstruct(field, p) reconstruct(field, dataCells(p))
#define readAt(field, p) readAt(field, dataCells(p))
#define readPart(field, like, p) readPart(field, like, dataCells(p))
#endif
