// The last two maps blended, so that the sky never jumps; they are dithered already.
uniform sampler2D sky_before;
uniform sampler2D sky_after;
uniform float share;

in vec2 v_uv;
flat in vec3 v_left;
out vec4 out_color;

void main() {
    vec4 shown = mix(texture(sky_before, v_uv), texture(sky_after, v_uv), share);
    out_color = vec4(1.0 - (1.0 - shown.rgb) * v_left, shown.a);
}
