// Shapes of lenses; twin: PlacedLens in vis/scene/lens.h. `u`: place in the lens, 1 / radius from its middle.

// 0 in the middle, 1 on the outline; `kind`: LENS_SHAPE_SPHERE, ...
float lensRadius(int kind, vec3 u) {
    float across = length(u.xy);
    return kind == LENS_SHAPE_SPHERE     ? length(u)
           : kind == LENS_SHAPE_BOX      ? max(max(abs(u.x), abs(u.y)), abs(u.z))
           : kind == LENS_SHAPE_CYLINDER ? max(across, abs(u.z))
                                         : across / max(1.0 + u.z, 1e-6);
}

// 1 inside, 0 outside, smoothstep over the share `rim` of the radius.
float lensWeight(float radius, float rim) {
    float t = rim > 0.0 ? clamp((1.0 - radius) / rim, 0.0, 1.0) : radius < 1.0 ? 1.0 : 0.0;
    return t * t * (3.0 - 2.0 * t);
}

// Share of the distance from the middle at which the data shown at a radius lie: graphical fisheye, backwards.
float lensShare(float radius, float magnification) {
    return radius < 1.0 ? 1.0 / (1.0 + (magnification - 1.0) * (1.0 - radius)) : 1.0;
}
