// A cloud's picture, or two of them while one gives way to the other; premultiplied, encoded.
#include "cloud_flash.glsl"
uniform sampler2D cloud_atlas;

in vec2 vs_uv;
in vec2 vs_before;
flat in vec4 vs_frame;
flat in vec4 vs_haze;
flat in vec2 vs_share;
flat in float vs_flash;
in vec3 vs_from;
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
    if ((cloud_flashes > 0 || vs_flash > 0.0) && texel.a > 0.0) {
        // What the picture shows darker is darker in this light too.
        vec3 shown = min(texel.rgb / texel.a, vec3(1.0));
        vec3 flash = own_flash(vs_flash, vec3(0.7)) + near_flash(vs_from);
        flash *= 0.45 + 1.1 * shown.g;
        texel.rgb = pow(pow(shown, vec3(2.2)) + flash, vec3(1.0 / 2.2)) * texel.a;
    }
    color = vec4(mix(texel.rgb, vs_haze.rgb * texel.a, vs_haze.w), texel.a) * vs_share.x;
}
