// Lists the drops in view, in their own order, so that only these are drawn and every run draws the
// same picture. A work group takes a chunk of 4096 drops, a thread 32 in a row; each chunk has its
// own stretch of the list and its own draw command. Of snow, flakes of a few pixels have commands of
// their own, behind all the others, and stand at the end of the stretch.
layout(local_size_x = 128) in;
#include "landed.glsl"
#include <block:RainView>

uniform uint streak_count;

layout(std430, binding = 1) readonly buffer Drops { float drops[]; };
layout(std430, binding = 2) writeonly buffer Seen { uint seen[]; };
struct DrawElements { uint count; uint instances; uint first; int base_vertex; uint base_instance; };
layout(std430, binding = 3) writeonly buffer Commands { DrawElements commands[]; };

const uint ROW = 32u;
shared uint found[128];  // by thread; the small ones in the upper half of the word

#ifdef SNOW
#include "snow_law.glsl"
#include "container.glsl"
#include <block:RainDraw>

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };

const float FAR_PIXELS = 7.0;  // diameter up to which a flake's picture does not show
const float LARGEST = 0.016;   // m, of a flake as it is: a clump of 4 mm of water
const float FOCUS = 6.0;       // m; also in flake.vert

// Of the largest of all flakes, m: what is farther off than it may be large needs no second look.
float largest()
{
    float size = LARGEST * drop_look.z * drop_look.y * max(drop_look.x, 1.0) + snow_look.x;
    return snow_motion.w == LIU_TONG ? 1.0 + snow_look.x : size;
}

// Whether a flake is small, about as flake.vert has it.
bool is_small(uint id)
{
    uint k = id * 6u;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    float deep = dot(p - camera_position.xyz, camera_forward.xyz);
    float d = min(length(to_container(p.xz, container_axis, container_shape.xy)), 1.0);
    float diameter = flake_diameter(births[id].w, drop_law);
    float size = flake_size(diameter, flake_habit(flake_word(id), drop_law), drop_law);
    size *= 1e-3 * drop_look.z * drop_look.y * (1.0 + (drop_look.x - 1.0) * d * d);
    if (snow_motion.w == LIU_TONG) size = 1.0;
    size += snow_look.x * max(1.0 - deep / FOCUS, 0.0);
    return size * camera_position.w < FAR_PIXELS * deep;
}
#endif

// deep: m, before the camera.
bool in_view(uint id, out float deep)
{
    uint k = id * 6u;
    vec3 v = vec3(0.0, drops[k + 4u], 0.0);
    deep = 0.0;
    if (has_landed(v)) return false;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    vec4 head = view_projection * vec4(p, 1.0);
    deep = head.w;
#ifdef SNOW
    // As in flake.vert: its way during the exposure is looked at there.
    return head.w > 0.15 && all(lessThan(abs(head.xy), head.ww * 1.05 + 0.05));
#else
    v.xz = vec2(drops[k + 3u], drops[k + 5u]);
    // As in streak.vert, and a little wider: far streaks are drawn longer than this.
    vec4 tail = head
        - view_projection * vec4((v - camera_velocity.xyz) * camera_velocity.w, 0.0);
    if (min(head.w, tail.w) < 0.1) return false;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    return all(lessThan(min(h, t), vec2(1.03))) && all(greaterThan(max(h, t), vec2(-1.03)));
#endif
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
        if (first + i < streak_count && in_view(first + i, deep)) {
            mask |= 1u << i;
            if (deep > large) small |= 1u << i;
        }
    }
#ifdef SNOW
    for (uint rest = mask ^ small; rest != 0u; rest &= rest - 1u)
        if (is_small(first + uint(findLSB(rest)))) small |= rest & (~rest + 1u);
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
