// The last two maps blended, so that the sky never jumps; they are dithered already.
uniform sampler2D sky_before;
uniform sampler2D sky_after;
uniform float share;

in vec2 v_uv;
out vec4 out_color;

void main() {
    out_color = mix(texture(sky_before, v_uv), texture(sky_after, v_uv), share);
}
