// Moves the drops of one container by transform feedback: the feedback backend.
#include "drop_step.glsl"

in vec4 in_birth;
in vec3 in_position;
in vec3 in_velocity;
out vec3 out_position;
out vec3 out_velocity;

void main()
{
    uint id = uint(gl_VertexID);
    vec3 p = in_position;
    vec3 v = in_velocity;
    bool stays = carry_drop(id, in_birth, p, v);
    if (!stays) {
        place_drop(id, in_birth, v, p);
        vec3 own = own_velocity(id, in_birth.w);
#ifdef STEADY_AIR
        v = air_velocity(p) + own;
#else
        uint word;
        int left;
        begin_entry(id, word, left);
        while (!try_entry(word, left, in_birth.z, own, p, v));
#endif
    }
    bool sinks = land_drop(p, v) && stays;
#if defined(SHELTER) && !defined(SNOW)
    vec3 normal;
    if (sinks) find_hit(in_position, p, v, normal);
#endif
    out_position = p;
    out_velocity = v;
    gl_Position = vec4(0.0);
}
