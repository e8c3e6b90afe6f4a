// The last two maps of the sky blended at the corners of a dome: but for the sun it is a soft ramp.
#include "frame.glsl"
#include "flash.glsl"
#include "sky_map.glsl"

uniform mat4 to_clip;  // directions from the camera to clip space
uniform sampler2D sky_before;
uniform sampler2D sky_after;
uniform float share;

in vec3 in_direction;
out vec3 v_color;

void main() {
    vec2 at = sky_uv(in_direction);
    vec3 before = textureLod(sky_before, at, 0.0).rgb;
    v_color = flash_on_sky(mix(before, textureLod(sky_after, at, 0.0).rgb, share), flash_left());
    vec4 place = to_clip * vec4(in_direction, 1.0);
    gl_Position = vec4(place.xy, place.w, place.w);  // behind everything
}
