// Where it can, from what vertices hand on: see ground.vert.
#include "frame.glsl"
#include "tone.glsl"
#include "fog_light.glsl"

#ifndef WILD                // where the painted map does not reach
uniform sampler2D meadow_map;
#endif
#ifdef LIVE                // shadows move here
uniform sampler2DShadow shadow_map;
#endif
#ifdef NEAR
uniform sampler2D detail_map;
#endif
#ifdef WET
#include "wetness.glsl"
#endif

const float FLUTTER = 1.6;  // m, between the drifts of flakes that land side by side

in vec4 v_light;
in vec4 v_haze;
in vec4 v_place;
in vec4 v_maps;
flat in vec3 v_eye;
flat in vec3 v_sun;
#ifdef LIVE
in vec3 v_shadow;
#endif
in float v_snow;
#ifdef NEAR
in float v_gust;
#ifdef WET
in vec3 v_sky;
#ifdef WATER
flat in float v_ragged;
in float v_rise;
#endif
#endif
#else
in vec4 v_wild;
flat in vec3 v_horizon;
#endif

out vec4 out_color;

void main() {
    vec3 p = v_place.xyz;
#ifdef NEAR
    vec4 air = v_haze;
#else
    vec4 air = haze_at(v_haze);
#endif
#ifdef WILD
    vec3 albedo = v_wild.rgb;
    float lit = 1.0;
#else
    vec4 painted = texture(meadow_map, v_maps.xy);
    vec3 albedo = painted.rgb * painted.rgb;
    float lit = painted.a;
#ifdef LIVE
    lit = texture(shadow_map, v_shadow);
#endif
#ifndef NEAR
    albedo = mix(v_wild.rgb, albedo, v_wild.a);
    lit = mix(1.0, lit, v_wild.a);
#endif
#endif
    float bare = clamp((albedo.r - albedo.g) * 20.0 - 0.3, 0.0, 1.0);  // earth is redder than grass
    float wet = v_place.w;
#ifdef NEAR
    vec4 detail = texture(detail_map, p.xz * 0.155) - 0.5;
    albedo *= 1.0 + mix(detail.b * 1.35 + v_gust, detail.g, bare);
#endif
    // Thin snow lies in the hollows first, and earth holds less of it than grass.
    float snowy = 0.0;
#if !defined(NEAR) && defined(SNOWS)
    snowy = smoothstep(0.0, 1.0, v_snow * 0.5 - 0.45 * bare);
#elif defined(WET) && defined(SNOWS)
    // Read aside by the grain, as flakes that flutter make no sharp edge under what stands over it.
    vec3 aside = vec3(detail.g + detail.a, 0.0, detail.b - detail.a) * FLUTTER;
    float deep = weather_snow(p + aside, vec3(0.0, v_snow, 0.0)) * 1000.0;
    snowy = smoothstep(0.0, 1.0, deep * 0.5 - 0.8 * (detail.g + detail.b) - 0.45 * bare);
    snowy *= min(deep * 3.0, 1.0);
#endif
    vec3 snow = SNOW;
#ifdef NEAR
    snow *= 1.0 + 0.14 * detail.b + 0.05 * detail.g;
#endif
    albedo = mix(albedo, snow, snowy);
    wet *= 1.0 - snowy;
    vec3 color = albedo * (v_light.rgb + v_sun * (v_light.a * lit));
#ifdef WET
#ifdef WATER
    // Read a little aside by the grain, so that where it is dry under a roof has a natural shore.
    float water = weather_water_at(v_maps.zw + detail.gb * v_ragged, p.y, v_place.w);
    wet = weather_damp(water) * (1.0 - snowy);
    float puddle = weather_pooled(water, 5.0 - 12.5 * detail.a + v_rise);
#else
    float puddle = clamp(detail.a * 8.5 + 0.35, 0.0, 1.0) * wet;
#endif
    puddle *= bare * (1.0 - snowy);
    color *= 1.0 - wet * (0.28 + 0.20 * bare) - 0.25 * puddle;
    vec3 view = v_eye - p;
    float away = 1.0 - view.y * inversesqrt(dot(view, view));
    float away2 = away * away;
    float fresnel = 0.02 + 0.98 * away2 * away2 * away;
    // Ruffled, it mirrors more of what is high or of what is low.
    vec3 sky = v_sky * (1.0 + (detail.b + detail.g) * (0.45 - 0.43 * puddle));
    color = tone(color * air.a + air.rgb);
    // Blended as display values, which the sky's map holds; the root makes up for it.
    float share = mix(fresnel * wet * (0.20 + 0.25 * bare), sqrt(fresnel) * 0.92, puddle);
    color = mix(color, sky, share * air.a);
    out_color = vec4(color, 1.0);
#else
#ifndef NEAR
    color *= 1.0 - wet * (0.28 + 0.20 * bare);
    color += v_horizon * (wet * (0.05 + 0.14 * bare));
#endif
    out_color = vec4(tone(color * air.a + air.rgb), 1.0);
#endif
}
