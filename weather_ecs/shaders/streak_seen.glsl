// Which drops are in view, and which flakes there are a few pixels large: alike for both backends.
#include "landed.glsl"
#include <block:RainView>
#ifdef SNOW
#include "snow_law.glsl"
#include "container.glsl"
#include <block:RainDraw>

const float FAR_PIXELS = 7.0;  // diameter up to which a flake's picture does not show
const float FOCUS = 6.0;       // m; also in flake.vert

// Whether a flake is small, about as flake.vert has it. deep: m, before the camera.
bool is_small(uint id, vec3 p, float quantile, float deep)
{
    float d = min(length(to_container(p.xz, container_axis, container_shape.xy)), 1.0);
    float diameter = flake_diameter(quantile, drop_law);
    float size = flake_size(diameter, flake_habit(flake_word(id), drop_law), drop_law);
    size *= 1e-3 * drop_look.z * drop_look.y * (1.0 + (drop_look.x - 1.0) * d * d);
    if (snow_motion.w == LIU_TONG) size = 1.0;
    size += snow_look.x * max(1.0 - deep / FOCUS, 0.0);
    return size * camera_position.w < FAR_PIXELS * deep;
}
#endif

// Of one that has not landed. deep: m, before the camera.
bool in_view(vec3 p, vec3 v, out float deep)
{
    vec4 head = view_projection * vec4(p, 1.0);
    deep = head.w;
#ifdef SNOW
    // As in flake.vert: its way during the exposure is looked at there.
    return head.w > 0.15 && all(lessThan(abs(head.xy), head.ww * 1.05 + 0.05));
#else
    // As in streak.vert, and a little wider: far streaks are drawn longer than this.
    vec4 tail = head
        - view_projection * vec4((v - camera_velocity.xyz) * camera_velocity.w, 0.0);
    if (min(head.w, tail.w) < 0.1) return false;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    return all(lessThan(min(h, t), vec2(1.03))) && all(greaterThan(max(h, t), vec2(-1.03)));
#endif
}
