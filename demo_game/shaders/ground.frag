#include "frame.glsl"
#include "tone.glsl"
#include "sky_map.glsl"

uniform sampler2D meadow_map;
uniform sampler2D detail_map;
uniform sampler2DShadow shadow_map;
uniform vec4 map_window;
uniform float lamp_scale;
#ifdef WET
uniform sampler2D sky_map;
in vec4 v_view;
#endif

in vec3 v_sky;
in vec3 v_sun;
in vec3 v_shadow;
in vec4 v_haze;
in vec4 v_wild;
in vec2 v_place;

out vec4 out_color;

void main() {
    float lit = texture(shadow_map, v_shadow);
    vec4 painted = texture(meadow_map, (v_place - map_window.xy) * map_window.zw);
    vec4 detail = texture(detail_map, v_place * 0.31);
    vec3 albedo = mix(v_wild.rgb, painted.rgb * painted.rgb, v_wild.a);
    float bare = smoothstep(0.015, 0.07, albedo.r - albedo.g);  // earth is redder than grass
    albedo *= 1.0 + mix(detail.b - 0.5, 0.7 * (detail.g - 0.5), bare) * 1.25;
    vec3 light = v_sky + v_sun * lit;
    light += vec3(1.0, 0.62, 0.30) * (painted.a * lamp_scale * v_wild.a * sun_direction.w);
#ifdef WET
    float wet = v_view.w;
    float puddle = smoothstep(0.50, 0.66, detail.a + 0.10 * bare) * bare * wet;
    albedo *= 1.0 - wet * (0.30 + 0.22 * bare);
    vec3 view = normalize(v_view.xyz);
    vec2 tilt = (detail.bg - 0.5) * mix(0.9, 0.04, puddle);
    vec3 mirror = normalize(vec3(-view.x + tilt.x, view.y, -view.z + tilt.y));
    float away = 1.0 - view.y;
    float fresnel = 0.02 + 0.98 * away * away * away * away * away;
    float share = fresnel * mix(wet * (0.16 + 0.22 * bare), 0.92, puddle);
    vec3 sky = sky_decode(texture(sky_map, sky_uv(mirror)).rgb);
    vec3 color = mix(albedo * (1.0 - 0.4 * puddle) * light, sky, share);
#else
    vec3 color = albedo * light;
#endif
    out_color = vec4(tone(color * v_haze.a + v_haze.rgb), 1.0);
}
