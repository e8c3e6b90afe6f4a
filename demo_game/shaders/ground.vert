// The ground: meadow with its painted map, hills beyond.
#include "frame.glsl"
#include "light.glsl"

in vec3 in_position;
in vec4 in_normal;
in vec4 in_color;     // square root of the albedo beyond the painted map, w: painted share

uniform vec4 map_window;  // low corner x, z, 1 / size x, z

out vec3 v_sky;
out vec3 v_sun;
out vec3 v_shadow;
out vec4 v_haze;
out vec4 v_wild;
out vec2 v_place;
#ifdef WET
out vec4 v_view;      // towards the camera, m; w wetness
#endif

void main() {
    vec3 n = normalize(in_normal.xyz);
    vec2 cover = rain_cover(in_position.xz);
    v_sky = sky_light(n, cover.x);
    v_sun = sun_light(max(dot(n, sun_direction.xyz), 0.0), cover.x);
    v_shadow = (shadow_matrix * vec4(in_position + n * 0.05, 1.0)).xyz;
    v_haze = haze(in_position);
    v_wild = vec4(in_color.rgb * in_color.rgb, in_color.a);
    v_place = in_position.xz;
#ifdef WET
    v_view = vec4(camera.xyz - in_position, cover.y);
#endif
    gl_Position = view_projection * vec4(in_position, 1.0);
}
