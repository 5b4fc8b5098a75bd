// A line segment as a screen-aligned strip of two triangles.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec2 scalars;

uniform vec3 worldScale, worldOffset; // world = sheet * scale + offset
uniform mat4 worldToClip;
uniform vec2 pixels;     // size of the picture in pixels
uniform float lineWidth; // pixels

out vec3 world, direction; // direction: along the line
out float value, side;     // side: -1 .. 1 across the line
flat out vec4 tint;

void main() {
    vec3 a = from * worldScale + worldOffset, b = to * worldScale + worldOffset;
    vec4 clipA = worldToClip * vec4(a, 1.0), clipB = worldToClip * vec4(b, 1.0);
    bool second = (gl_VertexID & 1) == 1;
    side = gl_VertexID >= 2 ? 1.0 : -1.0;
    vec2 along = (clipB.xy / max(clipB.w, 1e-6) - clipA.xy / max(clipA.w, 1e-6)) * pixels;
    along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
    world = second ? b : a;
    direction = b - a;
    value = second ? scalars.y : scalars.x;
    tint = vec4(-1.0, -1.0, -1.0, 1.0);
    gl_Position = second ? clipB : clipA;
    gl_Position.xy += vec2(-along.y, along.x) * side * lineWidth / pixels * gl_Position.w;
}
