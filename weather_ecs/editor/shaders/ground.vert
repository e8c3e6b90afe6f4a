#version 330 core
// The land below, as far as it can be seen from anywhere: a square round the eye.
uniform mat4 ground_matrix;
uniform vec4 ground_eye;  // m; half of the square's side
out vec3 vs_place;

void main()
{
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    vs_place = vec3(ground_eye.x + corner.x * ground_eye.w, 0.0, ground_eye.z + corner.y * ground_eye.w);
    gl_Position = ground_matrix * vec4(vs_place, 1.0);
}
