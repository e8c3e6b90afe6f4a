// A grid over the picture; the place in the sky's map is right at its corners, near enough between.
#include "sky_map.glsl"

in vec2 in_position;
uniform mat4 to_world;  // clip space to directions from the camera

out vec2 v_uv;

void main() {
    vec4 far = to_world * vec4(in_position, 1.0, 1.0);
    v_uv = sky_uv(far.xyz / far.w);
    gl_Position = vec4(in_position, 1.0, 1.0);
}
