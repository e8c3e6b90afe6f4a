uniform mat4 view_projection;
uniform mat4 place;

in vec3 in_vertex;
out vec3 vs_position;

void main()
{
    vec4 world = place * vec4(in_vertex, 1.0);
    vs_position = world.xyz;
    gl_Position = view_projection * world;
}
