// Intersection of rays with convex clip bodies; twin: vis/scene/clipping.h. An interval is empty if x >= y.
const float kFar = 1e6;

vec2 clipSlab(float offset, float slope, float halfWidth) {
    float s = abs(slope) < 1e-9 ? 1e-9 : slope;
    float a = (-halfWidth - offset) / s, b = (halfWidth - offset) / s;
    vec2 apart = abs(offset) <= halfWidth ? vec2(-kFar, kFar) : vec2(kFar, -kFar);
    return abs(slope) < 1e-9 ? apart : vec2(min(a, b), max(a, b));
}

vec2 clipBall(vec3 offset, vec3 slope, float radius) {
    float a = dot(slope, slope), b = dot(offset, slope), c = dot(offset, offset) - radius * radius;
    float root = b * b - a * c, width = sqrt(max(root, 0.0));
    vec2 apart = c <= 0.0 ? vec2(-kFar, kFar) : vec2(kFar, -kFar);
    vec2 met = root <= 0.0 ? vec2(kFar, -kFar) : vec2(-b - width, -b + width) / max(a, 1e-12);
    return a < 1e-12 ? apart : met;
}

// The interval of a line inside a body. `kind`: CLIP_KIND_PLANE, ...
vec2 clipInside(int kind, vec3 center, vec3 axis, vec3 halfSize, vec3 origin, vec3 direction) {
    vec3 from = origin - center;
    float offset = dot(axis, from), slope = dot(axis, direction);
    if (kind == CLIP_KIND_PLANE) {
        float at = -offset / (abs(slope) < 1e-9 ? 1e-9 : slope);
        vec2 apart = offset <= 0.0 ? vec2(-kFar, kFar) : vec2(kFar, -kFar);
        return abs(slope) < 1e-9 ? apart : slope > 0.0 ? vec2(-kFar, at) : vec2(at, kFar);
    }
    if (kind == CLIP_KIND_SPHERE) return clipBall(from, direction, halfSize.x);
    vec2 a, b;
    if (kind == CLIP_KIND_BOX) {
        vec2 x = clipSlab(from.x, direction.x, halfSize.x), y = clipSlab(from.y, direction.y, halfSize.y);
        a = vec2(max(x.x, y.x), min(x.y, y.y));
        b = clipSlab(from.z, direction.z, halfSize.z);
    } else {
        a = clipBall(from - offset * axis, direction - slope * axis, halfSize.x);
        b = clipSlab(offset, slope, halfSize.y);
    }
    return vec2(max(a.x, b.x), min(a.y, b.y));
}
