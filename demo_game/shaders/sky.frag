// The last two maps blended, so that the sky never jumps.
uniform sampler2D sky_before;
uniform sampler2D sky_after;
uniform float share;

in vec2 v_uv;
out vec4 out_color;

void main() {
    vec3 color = mix(texture(sky_before, v_uv).rgb, texture(sky_after, v_uv).rgb, share);
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    out_color = vec4(color + (grain - 0.5) / 255.0, 1.0);
}
