// Moves the drops of one container, in place: the single kernel of the compute backend.
layout(local_size_x = 128) in;
#include "drop_step.glsl"

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };
layout(std430, binding = 1) buffer Drops { float drops[]; };  // position, velocity: 6 floats

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id >= rain_count) return;
    uint k = id * 6u;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    vec3 v = vec3(drops[k + 3u], drops[k + 4u], drops[k + 5u]);
    step_drop(id, births[id], p, v);
    drops[k] = p.x;
    drops[k + 1u] = p.y;
    drops[k + 2u] = p.z;
    drops[k + 3u] = v.x;
    drops[k + 4u] = v.y;
    drops[k + 5u] = v.z;
}
