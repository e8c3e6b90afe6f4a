#version 330 core
// A line of some pixels' width: an instance a line, cut where it passes the eye.
uniform mat4 mark_matrix;
uniform vec2 mark_size;  // pixels of the picture
in vec3 in_from;
in vec3 in_to;
in vec4 in_color;
in float in_width;  // pixels
out vec4 vs_color;
out float vs_across;
out float vs_half;

void main()
{
    vec4 a = mark_matrix * vec4(in_from, 1.0), b = mark_matrix * vec4(in_to, 1.0);
    float near = 1e-3;
    if (a.w < near && b.w < near) {
        gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
        return;
    }
    if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
    if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
    vec2 pa = a.xy / a.w * mark_size, pb = b.xy / b.w * mark_size;
    vec2 along = pb - pa;
    along = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    vs_half = 0.5 * in_width;
    float reach = vs_half + 1.0;
    vec4 end = (gl_VertexID & 2) == 0 ? a : b;
    vec2 offset = vec2(-along.y, along.x) * side * reach * 2.0 / mark_size;
    gl_Position = vec4(end.xy + offset * end.w, 0.0, end.w);
    vs_color = in_color;
    vs_across = side * reach;
}
