// The sample positions along this pixel's ray; twin: RaySamples in vis/optics/ray_setup.h.

struct RaySamples {
    vec3 origin, direction;
    vec2 inside;         // entry and exit as distances along the ray
    bool meets;          // whether that interval is not empty
    int count;
    float stepLength;    // world units
    float phase;         // sample k lies at inside.x + (k + phase) * stepLength
    vec3 first;          // position of sample 0, in cells
    vec3 cellsPerSample;
};
RaySamples ray;

float distanceAt(float k) {
    return ray.inside.x + (k + ray.phase) * ray.stepLength;
}

vec3 worldAt(float k) {
    return ray.origin + ray.direction * distanceAt(k);
}

vec3 cellsAt(float k) {
    return ray.first + k * ray.cellsPerSample;
}

void beginRay() {
    vec2 ndc = gl_FragCoord.xy * ndcScale + ndcOffset;
    ray.origin = rayOrigin + ndc.x * rayOriginX + ndc.y * rayOriginY;
    ray.direction = normalize(rayDirection + ndc.x * rayDirectionX + ndc.y * rayDirectionY);
    ray.inside = clipToBox(ray.origin, ray.direction, halfSize);
    ray.inside.x = max(ray.inside.x, rayBegin);
    ray.inside = clipRay(ray.inside, ray.origin, ray.direction);
    ray.meets = ray.inside.x < ray.inside.y;
    float along = ray.meets ? ray.inside.y - ray.inside.x : 0.0;
    ray.count = ray.meets ? max(1, int(ceil(along * length(ray.direction / worldCell) / stepVoxels - 1e-4))) : 0;
    ray.stepLength = along / float(max(ray.count, 1));
    ray.cellsPerSample = ray.direction * ray.stepLength * cellsPerWorld;
    ray.phase = JITTER == 1 ? 0.5 + startJitter(uvec2(gl_FragCoord.xy), uint(passNumber)) : 0.5;
    ray.first = toCells(ray.origin + ray.direction * ray.inside.x) + ray.phase * ray.cellsPerSample;
    findHoles(ray.origin, ray.direction, ray.inside.x, ray.stepLength, ray.phase);
}
