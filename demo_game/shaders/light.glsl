// Light at a vertex. n unit normal, p world position; all linear RGB.
const vec3 LAMP_COLOR = vec3(1.0, 0.66, 0.36);
const float LAMP_STRENGTH = 1.5;
#include "wetness.glsl"
#include "cloud_shadow.glsl"
#include "fog_light.glsl"
#include "flash.glsl"

const float CLOUD_SHADOW = 0.85;  // of the daylight's share that rain clouds take

// x: share of daylight that clouds take at p, y: wetness that rain brings.
vec2 rain_cover(vec2 p) {
    vec2 cover = vec2(0.0);
#ifdef CLOUDED
    cover.x = CLOUD_SHADOW * (1.0 - weather_sunlight(vec3(p, 0.0).xzy));
#endif
    for (int i = 0; i < int(fog_color.w); i++) {
        vec2 d = p - area_shape[i].xy;
        vec2 turn = area_turn[i].xy;
        vec2 q = vec2(d.x * turn.x - d.y * turn.y, d.x * turn.y + d.y * turn.x);
        float r = length(q * area_shape[i].zw);
        cover.x = max(cover.x, area_turn[i].z * (1.0 - smoothstep(0.72, 1.35, r)));
        cover.y = max(cover.y, area_turn[i].w * (1.0 - smoothstep(0.86, 1.02, r)));
    }
    cover.y = max(cover.y, sun_color.w);
#ifdef WATER
    cover.y = weather_damp(weather_open_wetness(vec3(p, 0.0).xzy));
#endif
    return cover;
}

// 0 to 1: how thick rain falls at p.
float rain_falls(vec2 p) {
    float most = 0.0;
    for (int i = 0; i < int(fog_color.w); i++) {
        vec2 d = p - area_shape[i].xy;
        vec2 turn = area_turn[i].xy;
        vec2 q = vec2(d.x * turn.x - d.y * turn.y, d.x * turn.y + d.y * turn.x);
        float inside = 1.0 - smoothstep(0.9, 1.0, length(q * area_shape[i].zw));
        most = max(most, (2.0 * area_turn[i].z - 0.7) * inside);
    }
    return most;
}

// 0 to 1: how much of a surface at p with a unit normal n snow hides.
float snow_cover(vec3 p, vec3 n) {
#ifdef SNOWS
    return weather_snow_cover(weather_snow(p, n));
#else
    return 0.0;
#endif
}

// The same of grass and leaves at large, and of far ground.
float open_snow_cover(vec3 p) {
#ifdef SNOWS
    return weather_snow_cover(0.01 * weather_open_snow(p));
#else
    return 0.0;
#endif
}

vec3 sky_light(vec3 n, float dim) {
    vec3 above = mix(horizon_color.rgb, zenith_color.rgb, 0.5) * (0.92 - 0.30 * dim);
    vec3 below = ground_color.rgb * (1.0 - 0.3 * dim);
    return mix(below, above, n.y * 0.5 + 0.5);
}

float sun_share(float facing, float dim) {
    return facing * (1.0 - 0.90 * dim);
}

// Premultiplied haze: colour * a + rgb.
vec4 haze(vec3 p) {
    vec3 way = p - camera.xyz;
    float away = length(way);
    float thin = exp(-away * horizon_color.w);
    return vec4(fog_light(way / max(away, 0.01)) * (1.0 - thin), thin);
}

// The same in two steps, where vertices are so far apart that dense fog would not run straight
// between them: colour and optical depth first, then the haze of a pixel.
vec4 haze_depth(vec3 p) {
    vec3 way = p - camera.xyz;
    float away = length(way);
    return vec4(fog_light(way / max(away, 0.01)), away * horizon_color.w);
}
