// Anything but the ground: static meshes, instanced trees (TREES), moving parts (PARTS).
#include "frame.glsl"
#include "light.glsl"
#ifdef TREES
#include "breeze.glsl"
#endif

in vec3 in_position;
in vec4 in_normal;    // not unit, w: 127 times the sway
in vec4 in_color;     // square root of the albedo, w: sky seen
in vec4 in_extra;     // material / 255, part / 255, lamp light / 4, unused
in vec2 in_uv;

#ifdef TREES
in vec4 in_foot;      // xyz, w height m
in vec4 in_turn;      // cos, sin, lamp light, tint
#endif
#ifdef PARTS
uniform mat4 parts[12];
uniform vec4 part_light;  // x lamp light at the figure
uniform vec2 part_snow;   // m, on the figure, on the sails
#endif
uniform vec3 sun_full;

out vec3 v_shade;     // light of sky and lamps, haze included
#ifdef SOFT             // shadows are looked up here, once a vertex
uniform sampler2DShadow shadow_map;
#else
out vec3 v_sun;       // light of the sun where it is not in shadow
out vec3 v_shadow;
#endif
#if defined(GRAIN) || defined(LEAVES)
out vec2 v_uv;
#endif
#ifdef GRAIN
flat out vec2 v_mask; // wood, stone
#endif

void main() {
    vec3 n = in_normal.xyz;
    vec3 p = in_position;
    float material = in_extra.x * 255.0;
    float leaf = step(1.5, material) * step(material, 2.5);
    float lamp = in_extra.z * 4.0;
    vec3 albedo = in_color.rgb * in_color.rgb;
#ifdef TREES
    mat2 turn = mat2(in_turn.x, -in_turn.y, in_turn.y, in_turn.x);
    p *= in_foot.w;
    p.xz = turn * p.xz;
    n.xz = turn * n.xz;
    p += in_foot.xyz;
    float phase = wind.w + dot(in_foot.xz, vec2(0.37, 0.23)) + in_position.y * 2.0;
    float sway = in_normal.w / 127.0;
    float blows = wind_at(in_foot.xz);
    float bend = sway * sway * (0.05 + 0.024 * blows + 0.0026 * blows * blows);
    float to_and_fro = sin(phase) * mix(0.45, 0.22, smoothstep(6.0, 16.0, blows));
    p.xz += wind.xy * (bend * (0.55 + to_and_fro));
    float flutter = (0.03 + 0.004 * blows) * sway * min(blows * 0.2, 1.0);
    p.xz += vec2(sin(phase * 2.7 + in_position.x * 9.0), cos(phase * 2.3)) * flutter;
    albedo *= mix(1.0, in_turn.w, leaf);
    lamp = in_turn.z;
#endif
#ifdef PARTS
    mat4 part = parts[int(in_extra.y * 255.0 + 0.5)];
    p = (part * vec4(p, 1.0)).xyz;
    n = mat3(part) * n;
    lamp = part_light.x;
#endif
    n = normalize(n);
    float sky = in_color.a;
    vec2 cover = rain_cover(p.xz);
    float facing = dot(n, sun_direction.xyz);
    facing = mix(max(facing, 0.0), max((facing + 0.40) / 1.40, 0.0), leaf);
    float wet = cover.y * smoothstep(0.30, 0.75, sky);
    albedo *= 1.0 - 0.42 * wet * (0.55 + 0.45 * n.y) * (1.0 - 0.5 * leaf);
#ifdef PARTS
    // It stays on hat and shoulders, not on what swings.
    float which = in_extra.y * 255.0;
    float deep = which < 1.5 ? part_snow.x : which > 9.5 ? part_snow.y : 0.0;
    float snowy = weather_snow_cover(deep) * smoothstep(0.35, 0.75, n.y);
#elif defined(TREES)
    float snowy = open_snow_cover(p) * smoothstep(-0.35, 0.55, n.y) * smoothstep(0.2, 0.7, sky);
#else
    float snowy = snow_cover(p + vec3(0.0, 0.02, 0.0), n) * smoothstep(0.2, 0.5, sky);
#endif
    albedo = mix(albedo, SNOW, snowy);
    wet *= 1.0 - snowy;
    vec3 ambient = (sky_light(n, cover.x) + flash_light(p, n)) * sky;
    // Where no sky is seen lamps burn by day as well.
    float burn = mix(0.9, sun_direction.w, min(sky * 1.6, 1.0));
    ambient += LAMP_COLOR * (LAMP_STRENGTH * lamp * burn);
    vec3 shade = albedo * ambient;
    vec3 sun = albedo * sun_full * (sun_share(facing, cover.x) * mix(1.0, 0.3 + 0.7 * sky, leaf));
#ifndef TREES
    vec3 view = normalize(camera.xyz - p);
    float rim = 1.0 - max(dot(n, view), 0.0);
    float gloss = wet * max(n.y, 0.0) * (0.03 + 0.5 * rim * rim * rim * rim) * (1.0 - 0.6 * leaf);
    shade += mix(horizon_color.rgb, zenith_color.rgb, 0.3) * gloss * (1.0 - 0.35 * cover.x);
#endif
    if (material > 3.5) {
        shade = albedo * (0.5 + 3.6 * sun_direction.w);
        sun = vec3(0.0);
    }
    vec4 air = haze(p);
    vec3 shadow = (shadow_matrix * vec4(p + n * (0.04 + 0.25 * leaf), 1.0)).xyz;
#ifdef SOFT
    v_shade = (shade + sun * textureLod(shadow_map, shadow, 0.0)) * air.a + air.rgb;
#else
    v_shade = shade * air.a + air.rgb;
    v_sun = sun * air.a;
    v_shadow = shadow;
#endif
#ifdef GRAIN
    v_mask = vec2(step(material, 0.5), step(0.5, material) * step(material, 1.5)) * 0.9;
#endif
#ifdef LEAVES
    v_uv = in_uv;
#elif defined(GRAIN)
    v_uv = 0.5 * in_uv;
#endif
    gl_Position = view_projection * vec4(p, 1.0);
}
