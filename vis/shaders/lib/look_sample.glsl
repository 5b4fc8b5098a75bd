// Inputs of look shading for a sample of the ray caster; twin: lookSample in vis/reference/raycast.cpp.

// `perCell`: result of cellGradient() for the channel `field` at p; `t`: distance along the ray; `shown`: false skips
// gradients that are not visible.
LookSample lookSample(int i, int field, vec3 p, vec3 perCell, float weight, vec3 world, float t, vec3 direction,
                      float doi, bool shown) {
    LookSample at;
    at.share = lookShare[i].x + lookShare[i].y * doi;
    at.steepness = length(perCell) * layerMore[i].x;
    at.depth = clamp((t * dot(direction, rayDirection) - lookDepth.x) * lookDepth.y, 0.0, 1.0);
    at.pixel = lookPixel.x + lookPixel.y * t;
    vec3 gradient = shadingGradient(perCell);
    bool surface = dot(gradient, gradient) > 0.0;
    vec3 normal = surface ? normalize(gradient) : vec3(0.0);
    float along = dot(normal, -direction);
    at.weight = surface ? weight : 0.0;
    at.facing = abs(along);
    vec3 way = lookLight.xyz - world * lookLight.w;
    float front = clamp(0.5 + 0.5 * along / kEdgeOn, 0.0, 1.0);
    at.light = (2.0 * front - 1.0) * dot(normal, way) * inversesqrt(max(dot(way, way), 1e-12));
    at.curvature = 0.0;
    at.grain = vec2(0.5);
    at.wire = 0.0;
#if (LOOKS & LOOK_WIRE)
    if ((LAYER_LOOK(i) & LOOK_WIRE) != 0)
        at.wire = at.weight * wireCoverage(world, normal, -direction, lookWire[i].x, lookWire[i].y, at.pixel);
#endif
#if (LOOKS & LOOK_OUTLINE)
    if ((LAYER_LOOK(i) & LOOK_OUTLINE) != 0) {
        vec3 across = -direction - along * normal;
        across *= inversesqrt(max(dot(across, across), 1e-12));
        vec3 q = p + across * lookReach * cellsPerWorld;
        Reading here = readAt(field, p);
        vec2 there = readPart(field, here, q);
        float centre = present(there) ? there.x : kUnknown;
        vec3 other = shadingGradient(partGradient(field, here, q, centre, shown && surface));
        float size = dot(other, other);
        at.curvature = size > 0.0 ? abs(dot(other * inversesqrt(size) - normal, across)) / lookReach : 0.0;
    }
#endif
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0)
        at.grain = grainAt(grainTile, world, normal, lookGrain[i].x * at.pixel, lookGrain[i].yz);
#endif
    return at;
}
