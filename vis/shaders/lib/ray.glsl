// Geometry of rays; twins in vis/optics/ray_setup.h.

// Entry and exit of a ray in the box |p| <= halfSize; empty when x >= y.
vec2 clipToBox(vec3 origin, vec3 direction, vec3 halfSize) {
    vec3 d = mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 a = (-halfSize - origin) / d, b = (halfSize - origin) / d;
    vec3 lo = min(a, b), hi = max(a, b);
    return vec2(max(max(lo.x, lo.y), lo.z), min(min(hi.x, hi.y), hi.z));
}

// Opacity of a sample that stands for `lengths` reference lengths.
float correctedOpacity(float opacity, float lengths) {
    return 1.0 - pow(1.0 - clamp(opacity, 0.0, 1.0), lengths);
}
