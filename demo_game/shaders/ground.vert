// The ground: the meadow near the camera (NEAR, with WET), and everything beyond.
#include "frame.glsl"
#include "light.glsl"
#ifdef NEAR
#include "breeze.glsl"
#ifdef WET
#include "puddle_rise.glsl"
#include "sky_map.glsl"
uniform sampler2D sky_map;
#endif
#endif

in vec3 in_position;
in vec4 in_normal;    // times 127, w: m below the pond's water, the least where there is none
in vec4 in_color;     // square root of the albedo beyond the painted map, w: painted share

uniform vec4 map_window;  // low corner x, z, 1 / size x, z
uniform vec3 sun_full;    // light of a sun that is faced

out vec4 v_light;     // sky's rgb, sun's facing
out vec4 v_haze;
out vec4 v_place;     // m; w wetness, or mm of water (NEAR, WATER)
out vec4 v_maps;      // places in the painted map and in that of the water
// The same for all. From a block a software driver would fetch them for every few pixels anew.
flat out vec3 v_eye;
flat out vec3 v_sun;
#ifdef LIVE
out vec3 v_shadow;
#endif
out float v_snow;     // near: upward part of the normal; far: mm of snow
#ifdef NEAR
out float v_gust;     // how much brighter grass is that leans
#ifdef WET
out vec3 v_sky;       // what still water mirrors, display values
#ifdef WATER
flat out float v_ragged;  // half a metre in the map of the water
out float v_rise;         // mm of water that run off here to where the ground is lower
#endif
#endif
#else
out vec4 v_wild;
flat out vec3 v_horizon;
#endif

void main() {
    vec3 n = normalize(in_normal.xyz);
    vec2 cover = rain_cover(in_position.xz);
    // What falls into the pond melts; on its shore, which is not steep, snow begins at the water.
    float ashore = in_normal.w > -127.5 ? 0.65 - (8.0 / 127.0) * in_normal.w : n.y;
#ifdef NEAR
    v_snow = ashore;
#else
    v_snow = 0.0;
#ifdef SNOWS
    v_snow = 10.0 * weather_open_snow(in_position) * smoothstep(0.5, 0.8, ashore);
#endif
#endif
    vec3 around = sky_light(n, cover.x) + flash_light(in_position, n);
    v_light = vec4(around, sun_share(max(dot(n, sun_direction.xyz), 0.0), cover.x));
#ifdef NEAR
    v_haze = haze(in_position);
#else
    v_haze = haze_depth(in_position);
#endif
    v_place = vec4(in_position, cover.y);
    v_maps = vec4((in_position.xz - map_window.xy) * map_window.zw, 0.0, 0.0);
    v_eye = camera.xyz;
    v_sun = sun_full;
#ifdef LIVE
    v_shadow = (shadow_matrix * vec4(in_position, 1.0)).xyz;
#endif
#ifdef NEAR
#ifdef WET
    vec3 up = normalize(camera.xyz - in_position);
    v_sky = flash_on_sky(textureLod(sky_map, sky_uv_unit(up * vec3(-1.0, 1.0, -1.0)), 0.0).rgb,
                         flash_left());
#ifdef WATER
    v_place.w = weather_open_wetness(in_position);
    v_maps.zw = weather_wet_place(in_position);
    v_ragged = 0.5 * weather_wet_frame.z;
    v_rise = puddle_rise(in_position.xz);
#endif
#endif
    v_gust = 0.45 * grass_lean(in_position.xz) - 0.12;
#else
    v_horizon = horizon_color.rgb;
    v_wild = vec4(in_color.rgb * in_color.rgb, in_color.a);
#endif
    gl_Position = view_projection * vec4(in_position, 1.0);
}
