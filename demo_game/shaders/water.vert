#include "frame.glsl"
#include "light.glsl"

in vec4 in_position;  // w: depth m

out vec4 v_view;      // towards the camera, w depth
out vec3 v_light;
out vec4 v_haze;
out vec2 v_place;
flat out vec3 v_left;

void main() {
    vec2 cover = rain_cover(in_position.xz);
    v_view = vec4(camera.xyz - in_position.xyz, in_position.w);
    v_light = sky_light(vec3(0.0, 1.0, 0.0), cover.x) + sun_color.rgb * (0.8 * sun_share(sun_direction.y, cover.x));
    v_light += flash_light(in_position.xyz, vec3(0.0, 1.0, 0.0));
    v_haze = haze(in_position.xyz);
    v_left = flash_left();
    v_place = in_position.xz;
    gl_Position = view_projection * vec4(in_position.xyz, 1.0);
}
