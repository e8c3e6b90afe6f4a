#version 330
uniform mat4 to_clip;    // of places seen from the eye
uniform vec3 eye;        // m, world

in vec3 in_place;        // m, world
in vec3 in_normal;
in vec4 in_color;        // linear RGB; 1 open ground, 0 a thing that stands on it

out vec3 v_away;         // m, from the eye
out vec3 v_normal;
out vec4 v_color;

void main()
{
    v_away = in_place - eye;
    v_normal = in_normal;
    v_color = in_color;
    gl_Position = to_clip * vec4(v_away, 1.0);
}
