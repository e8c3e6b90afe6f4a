// Still water: sky in it by Fresnel's share, its own dark green below, thin at the shore.
#include "frame.glsl"
#include "tone.glsl"
#include "sky_map.glsl"

uniform sampler2D detail_map;
uniform sampler2D sky_map;
uniform sampler2D mirror_map;
uniform vec4 mirror;  // 1 / viewport width, height, share of the mirror map

in vec4 v_view;
in vec3 v_light;
in vec4 v_haze;
in vec2 v_place;

out vec4 out_color;

void main() {
    vec3 view = normalize(v_view.xyz);
    float drift = camera.w * 0.02;
    vec2 wave = texture(detail_map, v_place * 0.11 + drift).ba
              + texture(detail_map, v_place * 0.23 - drift * vec2(1.0, 0.6)).ab - 1.0;
    wave *= 0.035;
    vec3 up = vec3(-view.x + wave.x, view.y, -view.z + wave.y);
    vec3 sky = sky_decode(texture(sky_map, sky_uv(up)).rgb);
    vec4 scene = texture(mirror_map, gl_FragCoord.xy * mirror.xy + wave * vec2(0.6, 1.4));
    sky = mix(sky, sky_decode(scene.rgb), scene.a * mirror.z);
    float away = 1.0 - max(view.y, 0.0);
    float fresnel = 0.02 + 0.98 * away * away * away * away * away;
    float deep = 1.0 - exp(-v_view.w * 2.2);
    vec3 body = vec3(0.030, 0.042, 0.036) * v_light;
    vec3 color = mix(body, sky * 0.96, fresnel);
    float shore = smoothstep(0.0, 0.10, v_view.w);
    float opacity = shore * max(deep * 0.96, fresnel);
    out_color = vec4(tone(color * v_haze.a + v_haze.rgb), opacity);
}
