// Surface reflection models, in linear light. Formulas and papers in the twins: vis/optics/surface_light.h.

const float kEdgeOn = 0.25;

// A shading point: unit vectors in world axes, and how much the side of the normal faces the viewer.
struct Facing {
    vec3 normal, toViewer;
    float front;
};

Facing facing(vec3 gradient, vec3 toViewer) {
    Facing at;
    at.normal = normalize(gradient);
    at.toViewer = toViewer;
    at.front = clamp(0.5 + 0.5 * dot(at.normal, toViewer) / kEdgeOn, 0.0, 1.0);
    return at;
}

// `surface` = ambient, diffuse, specular, shininess.
vec3 phongLight(Facing at, vec3 albedo, vec3 toLight, vec4 surface) {
    float towards = dot(at.normal, toLight), glance = dot(at.normal, normalize(at.toViewer + toLight));
    float diffuse = abs(towards) * (towards > 0.0 ? at.front : 1.0 - at.front);
    float specular = pow(max(abs(glance), 1e-6), surface.w) * (glance > 0.0 ? at.front : 1.0 - at.front);
    return albedo * (surface.y * diffuse) + surface.z * specular;
}

// Compensation of multiple scattering between microfacets. `surface` = ambient, roughness, metalness, reflectance.
vec3 physicalLost(vec3 straight, vec4 surface) {
    return 1.0 + straight * (1.0 / (1.0 - 0.5 * surface.y * surface.y * surface.y) - 1.0);
}

// Reflection of uniform light of colour 1 from all directions: diffuse and specular part.
void physicalEvenLight(Facing at, vec3 albedo, vec4 surface, out vec3 diffuse, out vec3 specular) {
    float nv = abs(dot(at.normal, at.toViewer));
    vec4 r = surface.y * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec3 straight = mix(vec3(surface.w), albedo, surface.z);
    specular = min((straight * (-1.04 * a + r.z) + (1.04 * a + r.w)) * physicalLost(straight, surface), vec3(1.0));
    diffuse = (1.0 - specular) * (1.0 - surface.z) * albedo;
}

// `even`: the diffuse part from physicalEvenLight.
vec3 physicalLight(Facing at, vec3 albedo, vec3 even, vec3 toLight, vec4 surface) {
    vec3 halfway = normalize(at.toViewer + toLight);
    float towards = dot(at.normal, toLight);
    float nl = abs(towards), nv = max(abs(dot(at.normal, at.toViewer)), 1e-3);
    float alpha = surface.y * surface.y, a2 = alpha * alpha;
    // 1 - (n.h)^2 computed as |n x h|^2, accurate near the highlight of a smooth surface.
    vec3 across = cross(at.normal, halfway);
    float spread = a2 + dot(across, across) * (1.0 - a2);
    float visibility = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    vec3 straight = mix(vec3(surface.w), albedo, surface.z);
    float edge = 1.0 - clamp(dot(at.toViewer, halfway), 0.0, 1.0), edge2 = edge * edge;
    vec3 fresnel = straight + (1.0 - straight) * (edge2 * edge2 * edge);
    return nl * (towards > 0.0 ? at.front : 1.0 - at.front) *
           (even + a2 / (spread * spread) * visibility * fresnel * physicalLost(straight, surface));
}
