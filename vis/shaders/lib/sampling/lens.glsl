// Shapes of lenses; twin: PlacedLens in vis/scene/lens.h. `u`: position in lens coordinates, in units of the radius.

// Normalised radius: 0 at the centre, 1 on the outline. `kind`: LENS_SHAPE_SPHERE, ...
float lensRadius(int kind, vec3 u) {
    float across = length(u.xy);
    return kind == LENS_SHAPE_SPHERE     ? length(u)
           : kind == LENS_SHAPE_BOX      ? max(max(abs(u.x), abs(u.y)), abs(u.z))
           : kind == LENS_SHAPE_CYLINDER ? max(across, abs(u.z))
                                         : across / max(1.0 + u.z, 1e-6);
}

// 1 inside, 0 outside, smoothstep over the fraction `rim` of the radius.
float lensWeight(float radius, float rim) {
    float t = rim > 0.0 ? clamp((1.0 - radius) / rim, 0.0, 1.0) : radius < 1.0 ? 1.0 : 0.0;
    return t * t * (3.0 - 2.0 * t);
}

// Inverse graphical fisheye: factor by which the data shown at a radius are nearer to the centre.
float lensShare(float radius, float magnification) {
    return radius < 1.0 ? 1.0 / (1.0 + (magnification - 1.0) * (1.0 - radius)) : 1.0;
}
