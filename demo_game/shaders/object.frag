#include "tone.glsl"

#ifndef SOFT
uniform sampler2DShadow shadow_map;
in vec3 v_shadow;
#endif
#ifdef GRAIN
uniform sampler2D detail_map;
in vec2 v_uv;
flat in vec2 v_mask;
#endif

#ifdef LEAVES
uniform sampler2D leaf_map;
in vec2 v_uv;
#endif

in vec3 v_shade;
#ifndef SOFT
in vec3 v_sun;
#endif

out vec4 out_color;

void main() {
#ifdef LEAVES
    vec2 leaf = texture(leaf_map, v_uv).rg;
    if (leaf.g < 0.5) {
        discard;
    }
#endif
#ifdef SOFT
    vec3 color = v_shade;
#else
    vec3 color = v_shade + v_sun * texture(shadow_map, v_shadow);
#endif
#ifdef LEAVES
    color *= 0.5 + leaf.r;
#endif
#ifdef GRAIN
    color *= 1.0 + dot(texture(detail_map, v_uv).rg - 0.5, v_mask);
#endif
    out_color = vec4(tone(color), 1.0);
}
