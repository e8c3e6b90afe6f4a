// What one drop looks like: its streak's two ends, width and opacity; the drop stands for `weight`
// real ones, and what it hides of the picture, its profile counted, is their cross-section.
#include "drop_law.glsl"
#include "drop_weight.glsl"
#include "landed.glsl"
#include "drop_light.glsl"
#include "encode.glsl"
#include "fog.glsl"
#include <block:RainView>

in vec3 in_position;
in vec3 in_velocity;
in vec4 in_birth;

out vec4 vs_tail;   // clip space
out vec4 vs_head;
out vec4 vs_color;  // encoded, with opacity
out float vs_width; // pixels; 0 where there is nothing to draw

// Mean over a streak of what streak.frag leaves of its opacity: the rim, then both ends.
const float PROFILE = (1.0 - 0.4 / 3.0) * (1.0 - 0.5 / 3.0 - 0.5 / 6.0);

const float BOLD = 1.5e-3;  // m, from which on a drop may have the look's greatest opacity

void main()
{
    vs_width = 0.0;
    vs_tail = vs_head = vs_color = vec4(0.0);
    gl_Position = vec4(0.0);
    if (has_landed(in_velocity)) return;
    vec3 p = in_position;
    vec3 path = (in_velocity - camera_velocity.xyz) * camera_velocity.w;
    vec4 head = view_projection * vec4(p, 1.0);
    vec4 tail = view_projection * vec4(p - path, 1.0);
    if (min(head.w, tail.w) < 0.1) return;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    if (any(greaterThan(min(h, t), vec2(1.02))) || any(lessThan(max(h, t), vec2(-1.02)))) return;

    float d;
    float weight = drop_weight(p, in_birth.z, gl_VertexID, d);
    if (weight <= 0.0) return;
    float rise = (p.y - container_shape.z) / container_shape.w;
    weight *= clamp((1.0 - rise) * 8.0, 0.0, 1.0) * step(p.y, area_shape.w);

    float diameter = drop_diameter(in_birth.w, drop_law) * 1e-3;
    weight *= drop_arrived(p.y, drop_speed(diameter * 1e3), 0.0);
    float width = diameter * (1.0 + (drop_look.x - 1.0) * d * d) * drop_look.y * drop_look.z;
    path *= drop_look.y;  // far drops are drawn larger in all directions
    tail = view_projection * vec4(p - path, 1.0);
    if (tail.w < 0.1) return;

    // In pixels: what the streak takes as streak.geom draws it, and what it should cover.
    float scale = camera_position.w / head.w;
    float pixels = width * scale;
    float wide = max(pixels, 1.0);
    float span = length((h - tail.xy / tail.w) * 0.5 * view_size.xy);
    float drawn = PROFILE * wide * max(span, wide);
    float covered = 0.785398 * diameter * diameter * scale * scale * weight * drop_load.w;
    // A small drop's streak is the fainter, not only the shorter: drizzle is no thin heavy rain.
    float greatest = pow(drop_look.w, max(BOLD / diameter, 1.0));
    float opacity = min(covered / drawn, greatest * min(pixels, 1.0));
    opacity *= smoothstep(0.3, 1.6, head.w);
    if (opacity < 0.002) return;
    vs_width = wide;
    vs_head = head;
    vs_tail = tail;

    vec3 way = p - camera_position.xyz;
    float away = length(way);
    vs_color = vec4(encode(in_fog(drop_light(p, way / away), away)), opacity);
}
