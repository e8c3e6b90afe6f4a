// Soft glow round a lamp, always facing the camera.
#include "frame.glsl"

in vec2 in_corner;
in vec4 in_lamp;      // xyz, w strength

uniform mat4 view;

out vec2 v_corner;
out float v_strength;

void main() {
    vec3 right = vec3(view[0][0], view[1][0], view[2][0]);
    vec3 up = vec3(view[0][1], view[1][1], view[2][1]);
    float size = 0.95 * (0.6 + 0.4 * in_lamp.w);
    vec3 p = in_lamp.xyz + (right * in_corner.x + up * in_corner.y) * size;
    p += normalize(camera.xyz - in_lamp.xyz) * 0.35;
    float fade = exp(-distance(camera.xyz, p) * horizon_color.w);
    v_corner = in_corner;
    v_strength = in_lamp.w * sun_direction.w * fade;
    gl_Position = view_projection * vec4(p, 1.0);
}
