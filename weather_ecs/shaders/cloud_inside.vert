// A triangle over the whole picture, at a depth of its own.
uniform float inside_depth;  // -1 to 1

void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    gl_Position = vec4(corner, inside_depth, 1.0);
}
