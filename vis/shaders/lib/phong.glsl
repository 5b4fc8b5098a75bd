// Phong shading in linear light; twin: phong() in vis/model/ray_setup.h. `gradient` in world axes, any length;
// `weight` fades from the albedo to the lit colour; `light` = ambient, diffuse, specular, shininess. The side that faces
// the viewer is lit; seen edge-on, |n.v| < kEdgeOn, both are, mixed.
const float kEdgeOn = 0.25;

vec3 phong(vec3 albedo, vec3 gradient, float weight, vec3 toViewer, vec3 toLight, vec4 light) {
    float magnitude = length(gradient);
    if (!(magnitude > 0.0)) return albedo;
    vec3 normal = gradient / magnitude, halfway = normalize(toViewer + toLight);
    float front = clamp(0.5 + 0.5 * dot(normal, toViewer) / kEdgeOn, 0.0, 1.0);
    float towards = dot(normal, toLight), glance = dot(normal, halfway);
    float diffuse = abs(towards) * (towards > 0.0 ? front : 1.0 - front);
    float specular = pow(max(abs(glance), 1e-6), light.w) * (glance > 0.0 ? front : 1.0 - front);
    return mix(albedo, albedo * (light.x + light.y * diffuse) + light.z * specular, weight);
}
