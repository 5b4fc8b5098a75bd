// Projection from four dimensions to the picture. Twin: project() in vis/shapes/projection4.h.

// xy: position in -1..1 of the shorter side; z: depth 0..1; w: magnification there. `rotated` lies within the unit
// ball; `eyes`: distance of the eye along w and along z, zoom, and 1 for parallel projection, else 0; `stereo`: how far
// one eye of two lies aside, and where both see the same, in distances of the eye.
vec4 project4(vec4 rotated, vec4 eyes, vec2 stereo) {
    bool parallel = eyes.w > 0.5;
    float first = parallel ? 1.0 : eyes.x / (eyes.x - rotated.w);
    float radius3 = parallel ? 1.0 : eyes.x / sqrt(eyes.x * eyes.x - 1.0);
    float away = eyes.y * radius3;
    vec3 q = rotated.xyz * first;
    float second = parallel ? 1.0 : away / (away - q.z);
    float fit = eyes.z * (parallel ? 1.0 : sqrt(eyes.y * eyes.y - 1.0) / away);
    float nearer = parallel ? 1.0 + q.z / away : second;
    float shift = stereo.x * away * (1.0 / stereo.y - nearer);
    return vec4(vec2(q.x * second + shift, q.y * second) * fit, 0.5 - 0.5 * q.z / radius3, first * second * fit);
}
