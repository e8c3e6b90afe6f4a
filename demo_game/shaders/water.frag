// The pond: rings where drops land, sky in it by Fresnel's share, its own dark green below, thin at the shore.
#include "frame.glsl"
#include "tone.glsl"
#include "sky_map.glsl"
#include "ripple_sample.glsl"

uniform sampler2D detail_map;
uniform sampler2D sky_map;

in vec4 v_view;
in vec3 v_light;
in vec4 v_haze;
in vec2 v_place;
flat in vec3 v_left;  // of the sky's darkness, by lightning

out vec4 out_color;

void main() {
    vec3 view = normalize(v_view.xyz);
    float drift = camera.w * 0.02;
    vec2 wave = texture(detail_map, v_place * 0.065 + 0.5 * drift).ba - 0.5;
    // A pixel's share of the water as a square: rings far off are seen as thin as they are.
    float pixel = sqrt(abs(determinant(mat2(dFdx(v_place), dFdy(v_place)))));
    vec2 slope = ripple_slope(v_place, pixel);
    float facing = max(view.y - dot(slope, view.xz), 0.0);
    vec3 mirrored = vec3(wave * 0.05 - view.xz - slope * (2.0 * facing), 2.0 * facing - view.y).xzy;
    vec3 sky = texture(sky_map, sky_uv_unit(vec3(mirrored.x, abs(mirrored.y), mirrored.z))).rgb;
    sky = 1.0 - (1.0 - sky) * v_left;
    float away = 1.0 - facing;
    float away2 = away * away;
    float fresnel = 0.02 + 0.98 * away2 * away2 * away;
    float deep = 1.0 - exp(-v_view.w * 2.2);
    vec3 water = vec3(0.030, 0.042, 0.036) * max(1.0 - 5.0 * dot(slope, sun_direction.xz), 0.3);
    vec3 body = tone(water * v_light * v_haze.a + v_haze.rgb);
    float shore = clamp(v_view.w * 12.0, 0.0, 1.0);
    out_color = vec4(mix(body, sky, sqrt(fresnel)), shore * max(deep * 0.96, fresnel));
}
