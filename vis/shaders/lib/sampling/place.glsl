// Conversion between world and cells, and through magnifying lenses. Included after the slot reconstruct: later reads
// through reconstruct, readAt and readPart are redirected through the lenses.
#include "lib/sampling/lenses.glsl"

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
