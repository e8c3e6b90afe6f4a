// Looks at one drop for streak_cull.geom: the feedback backend.
#include "streak_seen.glsl"

uniform uint streak_count;

in vec3 in_position;
in vec3 in_velocity;
#ifdef APART
in vec4 in_birth;
#endif
out float vs_seen;  // 0: not in view; 1: in view; 2: that, and a few pixels large

void main()
{
    float deep;
    bool seen = in_view(in_position, in_velocity, deep);
    bool small = false;
    uint id = uint(gl_VertexID);
#ifdef APART
    // Of all, as a compiler for vectors takes every way.
    small = is_small(id, in_position, in_birth.w, deep);
#endif
    seen = seen && !has_landed(in_velocity) && id < streak_count;
    vs_seen = seen ? (small ? 2.0 : 1.0) : 0.0;
    gl_Position = vec4(0.0);
}
