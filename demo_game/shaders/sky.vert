// A grid over a part of the picture; the place in the sky's map is right at its corners, near enough between.
#include "frame.glsl"
#include "flash.glsl"
#include "sky_map.glsl"

in vec2 in_position;
uniform vec4 part;      // left, bottom, right, top, -1 to 1
uniform mat4 to_world;  // clip space to directions from the camera

out vec2 v_uv;
flat out vec3 v_left;  // of its darkness, by lightning

void main() {
    vec2 at = mix(part.xy, part.zw, in_position * 0.5 + 0.5);
    vec4 far = to_world * vec4(at, 1.0, 1.0);
    v_uv = sky_uv(far.xyz / far.w);
    v_left = flash_left();
    gl_Position = vec4(at, 1.0, 1.0);
}
