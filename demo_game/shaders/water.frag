// Still water: sky in it by Fresnel's share, its own dark green below, thin at the shore.
#include "frame.glsl"
#include "tone.glsl"
#include "sky_map.glsl"

uniform sampler2D detail_map;
uniform sampler2D sky_map;

in vec4 v_view;
in vec3 v_light;
in vec4 v_haze;
in vec2 v_place;

out vec4 out_color;

void main() {
    vec3 view = normalize(v_view.xyz);
    float drift = camera.w * 0.02;
    vec2 wave = texture(detail_map, v_place * 0.13 + drift).ba - 0.5;
    wave *= 0.05;
    vec3 sky = texture(sky_map, sky_uv_unit(vec3(wave - view.xz, view.y).xzy)).rgb;
    float away = 1.0 - max(view.y, 0.0);
    float away2 = away * away;
    float fresnel = 0.02 + 0.98 * away2 * away2 * away;
    float deep = 1.0 - exp(-v_view.w * 2.2);
    vec3 body = tone(vec3(0.030, 0.042, 0.036) * v_light * v_haze.a + v_haze.rgb);
    float shore = clamp(v_view.w * 12.0, 0.0, 1.0);
    out_color = vec4(mix(body, sky, sqrt(fresnel)), shore * max(deep * 0.96, fresnel));
}
