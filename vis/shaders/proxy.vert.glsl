// One triangle over the whole viewport per proxy surface, nearest first.
flat out int surface;

void main() {
    surface = gl_InstanceID;
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
