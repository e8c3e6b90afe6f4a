#include "tone.glsl"
#include "sky_map.glsl"

uniform sampler2D sky_before;
uniform sampler2D sky_after;
uniform float share;

in vec3 v_way;
out vec4 out_color;

void main() {
    vec2 uv = sky_uv(v_way);
    vec3 coded = mix(texture(sky_before, uv).rgb, texture(sky_after, uv).rgb, share);
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    out_color = vec4(tone(sky_decode(coded)) + (grain - 0.5) / 255.0, 1.0);
}
