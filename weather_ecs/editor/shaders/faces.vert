#version 330 core
// The faces of boxes, an instance a box of 36 corners.
uniform mat4 mark_matrix;
in vec3 in_center;
in vec3 in_size;
in vec4 in_color;
out vec4 vs_color;

void main()
{
    int face = gl_VertexID / 6, corner = gl_VertexID % 6;
    int axis = face >> 1;
    int place = corner < 3 ? corner : (corner == 3 ? 2 : (corner == 4 ? 1 : 3));
    vec3 p;
    p[axis] = float(face & 1) - 0.5;
    p[(axis + 1) % 3] = float(place & 1) - 0.5;
    p[(axis + 2) % 3] = float(place >> 1) - 0.5;
    gl_Position = mark_matrix * vec4(in_center + p * in_size, 1.0);
    gl_Position.z = 0.0;
    vs_color = in_color * vec4(vec3(axis == 1 ? 1.0 : (axis == 0 ? 0.85 : 0.7)), 1.0);
}
