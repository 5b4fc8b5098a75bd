// A line segment as a screen-aligned strip of two triangles.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec2 scalars;

uniform vec3 worldScale, worldOffset; // world = sheet * scale + offset
uniform mat4 worldToClip;
uniform vec2 pixels;     // size of the picture in pixels
uniform float lineWidth; // pixels
uniform float rim, pixelEdge; // rim around the line, > 0: that alone, and a pixel; world lengths at depth 1
uniform vec3 rayOrigin, forward;
uniform int perspective;

out vec3 world, direction; // direction: along the line
out float value, side, stroke; // side: -1 .. 1 across the line; stroke: 0
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
    stroke = 0.0;
    tint = vec4(-1.0, -1.0, -1.0, 1.0);
    gl_Position = second ? clipB : clipA;
    float width = lineWidth;
    if (rim > 0.0) { // behind the line by half its width
        width += 2.0 * rim / pixelEdge;
        vec3 away = perspective == 1 ? normalize(world - rayOrigin) : forward;
        world += away * (0.5 * width * pixelEdge * max(gl_Position.w, 0.0));
        gl_Position = worldToClip * vec4(world, 1.0);
    }
    gl_Position.xy += vec2(-along.y, along.x) * side * width / pixels * gl_Position.w;
}
