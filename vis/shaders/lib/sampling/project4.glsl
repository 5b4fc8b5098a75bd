// Projection from four dimensions to the picture. Twin: project() in vis/shapes/rotation4.h.

// xy: position in -1..1 of the shorter side; z: depth 0..1; w: magnification there. `rotated` lies within the unit
// ball; `eyes`: distance of the eye along w and along z, zoom.
vec4 project4(vec4 rotated, vec3 eyes) {
    float first = eyes.x / (eyes.x - rotated.w);
    float radius3 = eyes.x / sqrt(eyes.x * eyes.x - 1.0);
    float away = eyes.y * radius3;
    vec3 q = rotated.xyz * first;
    float scale = away / (away - q.z) * eyes.z * sqrt(eyes.y * eyes.y - 1.0) / away;
    return vec4(q.xy * scale, 0.5 - 0.5 * q.z / radius3, first * scale);
}
