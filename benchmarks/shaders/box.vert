// Hands a drop on; all else waits until the geometry shader knows that it is in view.
uniform mat4 view_projection;

in vec3 in_position;
in vec4 in_drop;

out vec3 vs_position;
out vec4 vs_drop;

void main()
{
    vs_position = in_position;
    vs_drop = in_drop;
    gl_Position = view_projection * vec4(in_position, 1.0);
}
