// Light at a vertex. n unit normal, p world position; all linear RGB.
const vec3 LAMP_COLOR = vec3(1.0, 0.66, 0.36);
const float LAMP_STRENGTH = 1.5;
#include "wetness.glsl"

// x: share of daylight the rain clouds take at p, y: wetness they bring.
vec2 rain_cover(vec2 p) {
    vec2 cover = vec2(0.0);
    for (int i = 0; i < int(fog_color.w); i++) {
        vec2 d = p - area_shape[i].xy;
        vec2 turn = area_turn[i].xy;
        vec2 q = vec2(d.x * turn.x - d.y * turn.y, d.x * turn.y + d.y * turn.x);
        float r = length(q * area_shape[i].zw);
        cover.x = max(cover.x, area_turn[i].z * (1.0 - smoothstep(0.72, 1.35, r)));
        cover.y = max(cover.y, area_turn[i].w * (1.0 - smoothstep(0.86, 1.02, r)));
    }
    cover.y = max(cover.y, sun_color.w);
    if (drift.z > 0.5) cover.y = weather_damp(weather_open_wetness(vec3(p, 0.0).xzy));
    return cover;
}

vec3 sky_light(vec3 n, float dim) {
    vec3 above = mix(horizon_color.rgb, zenith_color.rgb, 0.5) * (0.92 - 0.30 * dim);
    vec3 below = ground_color.rgb * (0.45 + 0.75 * sun_direction.y) * (1.0 - 0.3 * dim);
    return mix(below, above, n.y * 0.5 + 0.5);
}

float sun_share(float facing, float dim) {
    return facing * (1.0 - 0.90 * dim);
}

// Premultiplied haze: colour * a + rgb. It glows towards the sun, and is a little darker and
// bluer than the sky at the horizon, so that hills stand out from it.
vec4 haze(vec3 p) {
    vec3 way = p - camera.xyz;
    float away = length(way);
    float thin = exp(-away * horizon_color.w);
    float glow = max(dot(way, sun_direction.xyz) / max(away, 0.01), 0.0);
    vec3 color = fog_color.rgb * vec3(0.78, 0.84, 0.92);
    color += sun_color.rgb * (0.30 * glow * glow * glow * (1.0 - zenith_color.w));
    return vec4(color * (1.0 - thin), thin);
}
