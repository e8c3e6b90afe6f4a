in vec2 in_position;
uniform mat4 to_world;  // clip space to directions from the camera

out vec3 v_way;

void main() {
    vec4 far = to_world * vec4(in_position, 1.0, 1.0);
    v_way = far.xyz / far.w;
    gl_Position = vec4(in_position, 1.0, 1.0);
}
