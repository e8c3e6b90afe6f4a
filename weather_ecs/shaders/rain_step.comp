// Moves the drops of one container, in place: the single kernel of the compute backend. A thread
// takes a row of drops. In a step few of a row leave their container, and these are put in again
// together at the end: a compiler for vectors would work that out for every drop. What a drop that
// has come below the surface has hit is left to impact_find.comp, for the same reason.
layout(local_size_x = 64) in;
#include "drop_step.glsl"
// Snow lands silently: a flake that has come below the surface is gone, and nothing is listed.
#if defined(SHELTER) && !defined(SNOW)
#include "impact_counts.glsl"

layout(std430, binding = 4) writeonly buffer Sunk { uvec4 sunk[]; };  // place before, and drop
#endif

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };
layout(std430, binding = 1) buffer Drops { float drops[]; };  // position, velocity: 6 floats

const uint ACROSS = 64u;  // from one drop of a row to the next: the threads of a group
const uint ROW = 32u;

vec3 place_of(uint id)
{
    return vec3(drops[6u * id], drops[6u * id + 1u], drops[6u * id + 2u]);
}

vec3 velocity_of(uint id)
{
    return vec3(drops[6u * id + 3u], drops[6u * id + 4u], drops[6u * id + 5u]);
}

void keep(uint id, vec3 p, vec3 v)
{
    uint k = 6u * id;
    drops[k] = p.x;
    drops[k + 1u] = p.y;
    drops[k + 2u] = p.z;
    drops[k + 3u] = v.x;
    drops[k + 4u] = v.y;
    drops[k + 5u] = v.z;
}

void main()
{
    uint first = gl_WorkGroupID.x * ACROSS * ROW + gl_LocalInvocationID.x;
    uint gone = 0u;
    for (uint i = 0u; i < ROW; ++i) {
        uint id = first + i * ACROSS;
        if (id >= rain_count) break;
        vec3 before = place_of(id);
        vec3 p = before;
        vec3 v = velocity_of(id);
        bool stays = carry_drop(id, births[id], p, v);
        if (!stays) gone |= 1u << i;
        bool sinks = stays && land_drop(p, v);
        keep(id, p, v);
#if defined(SHELTER) && !defined(SNOW)
        if (sinks) {
            uint at = atomicAdd(sunk_count, 1u);
            if (at < uint(sunk.length())) {
                sunk[at] = uvec4(floatBitsToUint(before), id);
                if (at % FIND_GROUP == 0u) atomicAdd(find_groups.x, 1u);
            } else atomicAdd(impact_dropped, 1u);
        }
#endif
    }

    for (uint rest = gone; rest != 0u; rest &= rest - 1u) {
        uint id = first + uint(findLSB(rest)) * ACROSS;
        vec4 birth = births[id];
        vec3 p = place_of(id);
        vec3 v = velocity_of(id);
        place_drop(id, birth, v, p);
#ifdef STEADY_AIR
        v = air_velocity(p) + own_velocity(id, birth.w);
        land_drop(p, v);
#endif
        keep(id, p, v);
    }

#ifndef STEADY_AIR
    // One place is tried in each turn, so that threads do not wait for the drops of others.
    uint word;
    int left = -1;
    while (gone != 0u) {
        uint id = first + uint(findLSB(gone)) * ACROSS;
        vec4 birth = births[id];
        vec3 p = place_of(id);
        vec3 v;
        if (left < 0) begin_entry(id, word, left);
        if (try_entry(word, left, birth.z, own_velocity(id, birth.w), p, v)) {
            land_drop(p, v);
            keep(id, p, v);
            gone &= gone - 1u;
            left = -1;
        }
    }
#endif
}
