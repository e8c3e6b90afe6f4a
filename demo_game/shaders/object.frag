#include "tone.glsl"

uniform sampler2D detail_map;
uniform sampler2DShadow shadow_map;

in vec3 v_shade;
in vec3 v_sun;
in vec3 v_shadow;
in vec4 v_haze;
in vec2 v_uv;
flat in vec4 v_mask;

out vec4 out_color;

void main() {
    float lit = texture(shadow_map, v_shadow);
    vec4 grain = texture(detail_map, v_uv) - 0.5;
    vec3 color = (v_shade + v_sun * lit) * (1.0 + 0.9 * dot(grain, v_mask));
    out_color = vec4(tone(color * v_haze.a + v_haze.rgb), 1.0);
}
