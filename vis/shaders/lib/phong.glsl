// Phong shading in linear light; twin: phong() in vis/model/ray_setup.h. `gradient` in world axes, any length;
// `weight` fades from the albedo to the lit colour; `light` = ambient, diffuse, specular, shininess.
vec3 phong(vec3 albedo, vec3 gradient, float weight, vec3 toViewer, vec3 toLight, vec4 light) {
    float magnitude = length(gradient);
    if (!(magnitude > 0.0)) return albedo;
    vec3 normal = gradient / magnitude;
    if (dot(normal, toViewer) < 0.0) normal = -normal;
    vec3 halfway = normalize(toViewer + toLight);
    float diffuse = max(dot(normal, toLight), 0.0);
    float specular = pow(max(dot(normal, halfway), 1e-6), light.w);
    return mix(albedo, albedo * (light.x + light.y * diffuse) + light.z * specular, weight);
}
