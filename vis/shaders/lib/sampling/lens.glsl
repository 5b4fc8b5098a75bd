// Shapes of lenses; twin: PlacedLens in vis/scene/lens.h. `u`: position in lens coordinates, in units of the radius.
#include "formulas/lens_weight.glsl"

// Normalised radius: 0 at the centre, 1 on the outline. `kind`: LENS_SHAPE_SPHERE, ...
float lensRadius(int kind, vec3 u) {
    float across = length(u.xy);
    return kind == LENS_SHAPE_SPHERE     ? length(u)
           : kind == LENS_SHAPE_BOX      ? max(max(abs(u.x), abs(u.y)), abs(u.z))
           : kind == LENS_SHAPE_CYLINDER ? max(across, abs(u.z))
           : kind == LENS_SHAPE_DISC     ? across / max(1.0 + u.z, 1e-6)
                                         : 2.0; // a selection: nowhere inside
}
