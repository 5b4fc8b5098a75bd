// Inputs of look shading for a sample of the ray caster; twin: lookSample in vis/reference/raycast.cpp.

// The gradient that a look is shaded by: `perCell`, result of cellGradient() for the channel `field`, or that of a field
// smoothed over the width of the look. `centre`: value at p, or kUnknown.
vec3 lookGradient(int i, int field, Reading here, vec3 p, float centre, vec3 perCell, bool shown) {
#if (LOOKS & LOOK_SMOOTH)
    if ((LAYER_LOOK(i) & LOOK_SMOOTH) != 0)
        return smoothGradient(field, here, p, centre, perCell, lookSmooth[i].x, lookSmooth[i].y, shown);
#endif
    return perCell;
}

#if (LOOKS & LOOK_FOLLOW)
// Curvature of the surface through p by second differences on a circle in its tangent plane: see SurfaceBend in
// vis/optics/grain.h. `slope`: length of the gradient per world unit.
vec3 surfaceBend(int field, Reading here, vec3 world, vec3 normal, float slope, float centre, float reach, bool shown) {
    vec3 first = acrossNormal(normal), second = cross(normal, first);
    vec4 turned = vec4(0.0);
    for (int i = 0; i < (shown && FIELD_NEAREST(field) == 0 ? diagonals : 0); ++i) {
        float angle = 0.25 * kHalfTurn * float(i);
        vec3 offset = (cos(angle) * first + sin(angle) * second) * reach;
        vec2 lower = readPart(field, here, toCells(clamp(world - offset, -halfSize, halfSize)));
        vec2 upper = readPart(field, here, toCells(clamp(world + offset, -halfSize, halfSize)));
        float difference = (present(lower) ? lower.x : centre) + (present(upper) ? upper.x : centre) - 2.0 * centre;
        turned += difference * vec4(i == 0, i == 1, i == 2, i == 3);
    }
    vec3 bend = vec3(0.5 * dot(turned, vec4(1.0)), turned.x - turned.z, turned.y - turned.w);
    return centre > kUnknown && slope > 0.0 ? bend / (reach * slope) : vec3(0.0);
}
#endif

// `perCell`: result of cellGradient(), `drawn`: of lookGradient() for the channel `field` at p; `t`: distance along the
// ray; `shown`: false skips gradients that are not visible.
LookSample lookSample(int i, int field, vec3 p, vec3 perCell, vec3 drawn, float weight, vec3 world, float t,
                      vec3 direction, float doi, bool shown) {
    LookSample at;
    at.share = lookShare[i].x + lookShare[i].y * doi;
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
    at.grain = vec4(0.5);
    at.wire = 0.0;
#if (LOOKS & LOOK_WIRE)
    if ((LAYER_LOOK(i) & LOOK_WIRE) != 0)
        at.wire = at.weight * wireCoverage(world, normal, -direction, lookWire[i].x, lookWire[i].y, at.pixel);
#endif
#if (LOOKS & LOOK_OUTLINE)
    Reading here = readAt(field, p);
    if ((LAYER_LOOK(i) & LOOK_OUTLINE) != 0) {
        vec3 across = -direction - along * normal;
        across *= inversesqrt(max(dot(across, across), 1e-12));
        vec3 q = p + across * lookSmooth[i].z * cellsPerWorld;
        vec2 there = readPart(field, here, q);
        float centre = present(there) ? there.x : kUnknown;
        vec3 narrow = perCell;
        if ((LAYER_LOOK(i) & LOOK_SMOOTH) == 0) narrow = partGradient(field, here, q, centre, shown && surface);
        vec3 other = shadingGradient(lookGradient(i, field, here, q, centre, narrow, shown && surface));
        float size = dot(other, other);
        at.curvature = size > 0.0 ? abs(dot(other * inversesqrt(size) - normal, across)) / lookSmooth[i].z : 0.0;
    }
#endif
#if (LOOKS & LOOK_CHARCOAL)
    if ((LAYER_LOOK(i) & LOOK_CHARCOAL) != 0) {
        vec3 bend = vec3(0.0);
#if (LOOKS & LOOK_FOLLOW)
        if ((LAYER_LOOK(i) & LOOK_FOLLOW) != 0) {
            vec2 value = readPart(field, here, p);
            bend = surfaceBend(field, here, world, normal, length(gradient), present(value) ? value.x : kUnknown,
                               lookSmooth[i].w, shown && surface);
        }
#endif
        at.grain = marksAt(i, world, normal, bend, at.pixel);
    }
#endif
    return at;
}
