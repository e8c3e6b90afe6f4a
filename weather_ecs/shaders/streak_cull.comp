// Lists the drops in view, in their own order, so that only these are drawn and every run draws the
// same picture. A work group takes a chunk of 4096 drops, a thread 32 in a row; each chunk has its
// own stretch of the list and its own draw command. Of snow, flakes of a few pixels have commands of
// their own, behind all the others, and stand at the end of the stretch.
layout(local_size_x = 128) in;
#include "streak_seen.glsl"

uniform uint streak_count;

layout(std430, binding = 1) readonly buffer Drops { float drops[]; };
layout(std430, binding = 2) writeonly buffer Seen { uint seen[]; };
struct DrawElements { uint count; uint instances; uint first; int base_vertex; uint base_instance; };
layout(std430, binding = 3) writeonly buffer Commands { DrawElements commands[]; };

const uint ROW = 32u;
shared uint found[128];  // by thread; the small ones in the upper half of the word

#ifdef SNOW
layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };

const float LARGEST = 0.016;  // m, of a flake as it is: a clump of 4 mm of water

// Of the largest of all flakes, m: what is farther off than it may be large needs no second look.
float largest()
{
    float size = LARGEST * drop_look.z * drop_look.y * max(drop_look.x, 1.0) + snow_look.x;
    return snow_motion.w == LIU_TONG ? 1.0 + snow_look.x : size;
}

bool is_small_flake(uint id)
{
    uint k = id * 6u;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    return is_small(id, p, births[id].w, dot(p - camera_position.xyz, camera_forward.xyz));
}
#endif

// deep: m, before the camera.
bool is_seen(uint id, out float deep)
{
    uint k = id * 6u;
    vec3 v = vec3(0.0, drops[k + 4u], 0.0);
    deep = 0.0;
    if (has_landed(v)) return false;
#ifndef SNOW
    v.xz = vec2(drops[k + 3u], drops[k + 5u]);
#endif
    return in_view(vec3(drops[k], drops[k + 1u], drops[k + 2u]), v, deep);
}

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint first = gl_GlobalInvocationID.x * ROW;
    uint mask = 0u;
    uint small = 0u;
    float large = 0.0;
#ifdef SNOW
    large = largest() * camera_position.w / FAR_PIXELS;
#endif
    float deep;
    for (uint i = 0u; i < ROW; ++i) {
        if (first + i < streak_count && is_seen(first + i, deep)) {
            mask |= 1u << i;
            if (deep > large) small |= 1u << i;
        }
    }
#ifdef SNOW
    for (uint rest = mask ^ small; rest != 0u; rest &= rest - 1u)
        if (is_small_flake(first + uint(findLSB(rest)))) small |= rest & (~rest + 1u);
    mask ^= small;
#else
    small = 0u;
#endif
    found[thread] = bitCount(mask) | bitCount(small) << 16u;
    barrier();
    uint at = 0u;
    uint total = 0u;
    for (uint i = 0u; i < 128u; ++i) {
        if (i == thread) at = total;
        total += found[i];
    }
    uint start = gl_WorkGroupID.x * 128u * ROW;
    for (uint rest = mask, to = start + (at & 0xFFFFu); rest != 0u; rest &= rest - 1u)
        seen[to++] = first + uint(findLSB(rest));
    if (thread == 0u)
        commands[gl_WorkGroupID.x] = DrawElements(total & 0xFFFFu, 1u, start, 0, 0u);
#ifdef SNOW
    // Of the last chunk the list may be short.
    uint end = min(start + 128u * ROW, uint(seen.length())) - (total >> 16u);
    for (uint rest = small, to = end + (at >> 16u); rest != 0u; rest &= rest - 1u)
        seen[to++] = first + uint(findLSB(rest));
    if (thread == 0u)
        commands[gl_NumWorkGroups.x + gl_WorkGroupID.x]
            = DrawElements(total >> 16u, 1u, end, 0, 0u);
#endif
}
