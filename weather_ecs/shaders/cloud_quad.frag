// A cloud's picture, or two of them while one gives way to the other; premultiplied, encoded.
uniform sampler2D cloud_atlas;

in vec2 vs_uv;
in vec2 vs_before;
flat in vec4 vs_frame;
flat in vec4 vs_haze;
flat in vec2 vs_share;
out vec4 color;

void main()
{
    vec4 texel = texture(cloud_atlas, vs_uv);
    if (vs_share.y < 1.0) {
        vec2 at = vs_before;
        vec2 inside = step(abs(at - 0.5), vec2(0.5));
        vec4 before = texture(cloud_atlas, vs_frame.xy + vs_frame.zw * at);
        texel = mix(before * (inside.x * inside.y), texel, vs_share.y);
    }
    color = vec4(mix(texel.rgb, vs_haze.rgb * texel.a, vs_haze.w), texel.a) * vs_share.x;
}
