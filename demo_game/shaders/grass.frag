#include "tone.glsl"

uniform sampler2DShadow shadow_map;

in vec3 v_shade;
in vec3 v_sun;
in vec3 v_shadow;
in vec4 v_haze;

out vec4 out_color;

void main() {
    vec3 color = v_shade + v_sun * texture(shadow_map, v_shadow);
    out_color = vec4(tone(color * v_haze.a + v_haze.rgb), 1.0);
}
