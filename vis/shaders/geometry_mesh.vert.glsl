// Vertices of a mesh in physical coordinates.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float scalar;
layout(location = 3) in vec4 ownTint;
layout(location = 4) in float ownStroke;

uniform vec3 worldScale, worldOffset; // world = sheet * scale + offset
uniform mat4 worldToClip;
uniform float rim; // > 0: the rim around the mesh; world length at depth 1

out vec3 world, direction; // direction: the normal, not normalised
out float value, side, stroke; // stroke: by how much it is lighter or darker
flat out vec4 tint; // linear light and opacity; red below 0: coloured by the value

void main() {
    world = position * worldScale + worldOffset;
    direction = normal / worldScale;
    value = scalar;
    side = 0.0;
    stroke = ownStroke;
    tint = ownTint;
    gl_Position = worldToClip * vec4(world, 1.0);
    if (rim > 0.0 && dot(direction, direction) > 0.0) {
        world += normalize(direction) * (rim * max(gl_Position.w, 0.0));
        gl_Position = worldToClip * vec4(world, 1.0);
    }
}
