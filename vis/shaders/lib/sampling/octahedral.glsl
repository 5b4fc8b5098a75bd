// Directions quantised to `bits` per coordinate on the unfolded octahedron (Q. Meyer et al.: On floating-point normal
// vectors, 2010). Returns a unit vector for a vector of any length; zero stays zero. Twin: quantizedDirection() in
// vis/optics/ray_setup.h.
vec3 quantizedDirection(vec3 v, int bits) {
    float sum = abs(v.x) + abs(v.y) + abs(v.z);
    if (!(sum > 0.0)) return vec3(0.0);
    v /= sum;
    vec2 signs = vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
    vec2 at = v.z < 0.0 ? (1.0 - abs(v.yx)) * signs : v.xy;
    float steps = exp2(float(bits)) - 1.0;
    at = floor((0.5 * at + 0.5) * steps + 0.5) / steps * 2.0 - 1.0;
    vec3 n = vec3(at, 1.0 - abs(at.x) - abs(at.y));
    signs = vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * signs;
    return normalize(n);
}
