// Moves the drops of one container by transform feedback: the feedback backend.
#include "drop_step.glsl"

in vec4 in_birth;
in vec3 in_position;
in vec3 in_velocity;
out vec3 out_position;
out vec3 out_velocity;

void main()
{
    vec3 p = in_position;
    vec3 v = in_velocity;
    bool sinks = step_drop(uint(gl_VertexID), in_birth, p, v);
#if defined(SHELTER) && !defined(SNOW)
    vec3 normal;
    if (sinks) find_hit(in_position, p, v, normal);
#endif
    out_position = p;
    out_velocity = v;
    gl_Position = vec4(0.0);
}
