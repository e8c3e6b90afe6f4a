// Moves the drops of one container, in place: the single kernel of the compute backend. What a drop
// that has come below the surface has hit is left to impact_find.comp: those are few in a step, and
// here they would hold up all the others of their group.
layout(local_size_x = 128) in;
#include "drop_step.glsl"
// Snow lands silently: a flake that has come below the surface is gone, and nothing is listed.
#if defined(SHELTER) && !defined(SNOW)
#include "impact_counts.glsl"

layout(std430, binding = 4) writeonly buffer Sunk { uvec4 sunk[]; };  // place before, and drop
#endif

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };
layout(std430, binding = 1) buffer Drops { float drops[]; };  // position, velocity: 6 floats

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id >= rain_count) return;
    uint k = id * 6u;
    vec3 before = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    vec3 p = before;
    vec3 v = vec3(drops[k + 3u], drops[k + 4u], drops[k + 5u]);
    bool sinks = step_drop(id, births[id], p, v);
    drops[k] = p.x;
    drops[k + 1u] = p.y;
    drops[k + 2u] = p.z;
    drops[k + 3u] = v.x;
    drops[k + 4u] = v.y;
    drops[k + 5u] = v.z;
#if defined(SHELTER) && !defined(SNOW)
    if (sinks) {
        uint at = atomicAdd(sunk_count, 1u);
        if (at >= uint(sunk.length())) {
            atomicAdd(impact_dropped, 1u);
            return;
        }
        sunk[at] = uvec4(floatBitsToUint(before), id);
        if (at % FIND_GROUP == 0u) atomicAdd(find_groups.x, 1u);
    }
#endif
}
