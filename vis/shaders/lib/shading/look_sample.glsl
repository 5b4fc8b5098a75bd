// Inputs of look shading for a sample of the ray caster; twin: vis/optics/look_sample.h.

// The gradient that a look is shaded by: `perCell`, result of cellGradient() for the channel `field`, or that of a field
// smoothed over the width of the look. `centre`: value at p, or kUnknown.
vec3 lookGradient(int i, int field, Reading here, vec3 p, float centre, vec3 perCell, bool shown) {
#if (LOOKS & LOOK_SMOOTH)
    if ((LAYER_LOOK(i) & LOOK_SMOOTH) != 0)
        return smoothGradient(field, here, p, centre, perCell, lookSmooth[i].x, lookSmooth[i].y, shown);
#endif
    return perCell;
}

#if (LOOKS & LOOK_OUTLINE)
// The sum of the values at p - offset and p + offset, less twice that at p; absent ones are like it.
float secondDifference(int field, Reading here, vec3 world, vec3 offset, float centre) {
    vec2 lower = readPart(field, here, toCells(clamp(world - offset, -halfSize, halfSize)));
    vec2 upper = readPart(field, here, toCells(clamp(world + offset, -halfSize, halfSize)));
    return (present(lower) ? lower.x : centre) + (present(upper) ? upper.x : centre) - 2.0 * centre;
}
#endif

#if (LOOKS & LOOK_FOLLOW)
// SurfaceBend of vis/optics/grain.h, times the length of the gradient per `reach`.
vec3 surfaceBend(int field, Reading here, vec3 world, vec3 normal, float centre, float reach, bool needed) {
    vec3 first = acrossNormal(normal), second = cross(normal, first);
    vec4 turned = vec4(0.0);
    for (int i = 0; i < (needed ? diagonals : 0); ++i) {
        float angle = 0.25 * kHalfTurn * float(i);
        vec3 offset = (cos(angle) * first + sin(angle) * second) * reach;
        turned += secondDifference(field, here, world, offset, centre) * vec4(i == 0, i == 1, i == 2, i == 3);
    }
    return vec3(0.5 * dot(turned, vec4(1.0)), turned.x - turned.z, turned.y - turned.w);
}
#endif

// `perCell`: result of cellGradient(), `drawn`: of lookGradient() for the channel `field` at p, where its value is
// `centre` or kUnknown; `t`: distance along the ray; `shown`: false skips gradients that are not visible.
LookSample lookSample(int i, int field, vec3 p, float centre, vec3 perCell, vec3 drawn, float weight, vec3 world,
                      float t, vec3 direction, float doi, bool shown) {
    LookSample at;
    at.share = shown ? lookShare[i].x + lookShare[i].y * doi : 0.0;
    at.world = world;
    at.steepness = length(perCell) * layerMore[i].x;
    at.depth = clamp((t * dot(direction, rayDirection) - lookDepth.x) * lookDepth.y, 0.0, 1.0);
    at.pixel = lookPixel.x + lookPixel.y * t;
    vec3 gradient = shadingGradient(drawn);
    bool surface = dot(gradient, gradient) > 0.0;
    vec3 normal = surface ? normalize(gradient) : vec3(0.0);
    float along = dot(normal, -direction);
    at.weight = surface ? weight : 0.0;
    at.facing = abs(along);
    vec3 way = lookLight.xyz - world * lookLight.w;
    float front = clamp(0.5 + 0.5 * along / kEdgeOn, 0.0, 1.0);
    at.light = (2.0 * front - 1.0) * dot(normal, way) * inversesqrt(max(dot(way, way), 1e-12));
    at.curvature = 0.0;
    at.normal = normal;
    at.bend = vec3(0.0);
    at.wire = 0.0;
    at.cut = kNoCut;
#if (LOOKS & LOOK_WIRE)
    if ((LAYER_LOOK(i) & LOOK_WIRE) != 0)
        at.wire = at.weight * wireCoverage(world, normal, -direction, lookWire[i].x, lookWire[i].y, at.pixel);
#endif
#if (LOOKS & LOOK_OUTLINE)
    if ((LAYER_LOOK(i) & LOOK_OUTLINE) != 0) {
        bool curved = shown && surface && centre > kUnknown && FIELD_NEAREST(field) == 0;
        Reading here = readAt(field, p);
        vec3 across = -direction - along * normal;
        across *= inversesqrt(max(dot(across, across), 1e-12));
        float reach = lookSmooth[i].z, perReach = curved ? 1.0 / (reach * length(gradient)) : 0.0, turned = 0.0;
#if (LOOKS & LOOK_FOLLOW)
        if ((LAYER_LOOK(i) & LOOK_FOLLOW) != 0) {
            at.bend = perReach * surfaceBend(field, here, world, normal, centre, reach, curved);
            turned = bendAlong(at.bend, normal, across);
        } else
#endif
        for (int once = 0; once < (curved ? min(diagonals, 1) : 0); ++once)
            turned = perReach * secondDifference(field, here, world, across * reach, centre);
        at.curvature = abs(turned) / reach;
    }
#endif
    return at;
}
