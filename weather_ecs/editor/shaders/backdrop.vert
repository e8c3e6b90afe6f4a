#version 330
uniform mat4 from_clip;  // to directions from the eye

out vec3 v_way;

void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    vec4 far = from_clip * vec4(corner, 1.0, 1.0);
    v_way = far.xyz / far.w;
    gl_Position = vec4(corner, 0.0, 1.0);
}
