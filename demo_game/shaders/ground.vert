// The ground: the meadow near the camera (NEAR, with WET), and everything beyond.
#include "frame.glsl"
#include "light.glsl"

in vec3 in_position;
in vec4 in_normal;
in vec4 in_color;     // square root of the albedo beyond the painted map, w: painted share

out vec4 v_light;     // sky's rgb, sun's facing
out vec4 v_haze;
out vec4 v_view;      // towards the camera, m; w wetness
#ifndef NEAR
out vec4 v_wild;
#endif

void main() {
    vec3 n = normalize(in_normal.xyz);
    vec2 cover = rain_cover(in_position.xz);
    v_light = vec4(sky_light(n, cover.x), sun_share(max(dot(n, sun_direction.xyz), 0.0), cover.x));
    v_haze = haze(in_position);
    v_view = vec4(camera.xyz - in_position, cover.y);
#ifndef NEAR
    v_wild = vec4(in_color.rgb * in_color.rgb, in_color.a);
#endif
    gl_Position = view_projection * vec4(in_position, 1.0);
}
