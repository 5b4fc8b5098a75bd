// Geometry of rays; twins in vis/optics/ray_setup.h.

// Interval of a ray inside the box |p| <= halfSize; empty if x >= y.
vec2 clipToBox(vec3 origin, vec3 direction, vec3 halfSize) {
    vec3 d = mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 a = (-halfSize - origin) / d, b = (halfSize - origin) / d;
    vec3 lo = min(a, b), hi = max(a, b);
    return vec2(max(max(lo.x, lo.y), lo.z), min(min(hi.x, hi.y), hi.z));
}

// Opacity correction for a segment of `lengths` reference lengths.
float correctedOpacity(float opacity, float lengths) {
    return 1.0 - pow(1.0 - clamp(opacity, 0.0, 1.0), lengths);
}
