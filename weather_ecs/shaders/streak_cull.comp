// Lists the drops in view, in their own order, so that only these are drawn and every run draws the
// same picture. A work group takes a chunk of 4096 drops, a thread 32 in a row; each chunk has its
// own stretch of the list and its own draw command.
layout(local_size_x = 128) in;
#include "landed.glsl"
#include <block:RainView>

uniform uint streak_count;

layout(std430, binding = 1) readonly buffer Drops { float drops[]; };
layout(std430, binding = 2) writeonly buffer Seen { uint seen[]; };
struct DrawElements { uint count; uint instances; uint first; int base_vertex; uint base_instance; };
layout(std430, binding = 3) writeonly buffer Commands { DrawElements commands[]; };

const uint ROW = 32u;
shared uint found[128];

bool in_view(uint id)
{
    uint k = id * 6u;
    vec3 v = vec3(drops[k + 3u], drops[k + 4u], drops[k + 5u]);
    if (has_landed(v)) return false;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    // As in streak.vert, and a little wider: far streaks are drawn longer than this.
    vec4 head = view_projection * vec4(p, 1.0);
    vec4 tail = head
        - view_projection * vec4((v - camera_velocity.xyz) * camera_velocity.w, 0.0);
    if (min(head.w, tail.w) < 0.1) return false;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    return all(lessThan(min(h, t), vec2(1.03))) && all(greaterThan(max(h, t), vec2(-1.03)));
}

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint first = gl_GlobalInvocationID.x * ROW;
    uint mask = 0u;
    for (uint i = 0u; i < ROW; ++i)
        if (first + i < streak_count && in_view(first + i)) mask |= 1u << i;
    found[thread] = bitCount(mask);
    barrier();
    uint at = 0u;
    uint total = 0u;
    for (uint i = 0u; i < 128u; ++i) {
        if (i == thread) at = total;
        total += found[i];
    }
    uint start = gl_WorkGroupID.x * 128u * ROW;
    for (uint rest = mask, to = start + at; rest != 0u; rest &= rest - 1u)
        seen[to++] = first + uint(findLSB(rest));
    if (thread == 0u) commands[gl_WorkGroupID.x] = DrawElements(total, 1u, start, 0, 0u);
}
