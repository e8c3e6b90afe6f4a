// Ground near a lamp, drawn once more to add its light.
#include "frame.glsl"

in vec3 in_position;
in vec4 in_lamp;      // xyz, w strength

out vec3 v_way;
out float v_strength;

void main() {
    v_way = in_lamp.xyz - in_position;
    v_strength = in_lamp.w * sun_direction.w
               * exp(-distance(camera.xyz, in_position) * horizon_color.w);
    gl_Position = view_projection * vec4(in_position, 1.0);
}
