// A cloud's picture; with FADING two of them, while one gives way to the other; premultiplied,
// encoded. FLASHES: in the light of lightning. These are programs apart: where the CPU draws, what
// is not needed costs as much as what is.
#ifdef FLASHES
#include "cloud_share.glsl"
#endif
uniform sampler2D cloud_atlas;

#ifndef FADING
in vec2 vs_uv;
#endif
flat in vec4 vs_haze;  // encoded and times its share; the share
flat in vec2 vs_share;  // opacity, and share of the newer picture
#ifdef FADING
in vec2 vs_now;
flat in vec3 vs_tile;
in vec2 vs_before;
flat in vec4 vs_frame;
#endif
#ifdef FLASHES
in vec3 vs_from;
flat in vec4 vs_flash_at;
flat in vec3 vs_flash_color;
in vec3 vs_others;
#endif
out vec4 color;

void main()
{
#ifndef FADING
    vec4 texel = texture(cloud_atlas, vs_uv);
#else
    vec2 within = step(abs(vs_now - 0.5), vec2(0.5));
    vec4 texel = texture(cloud_atlas, vs_tile.xy + vs_tile.z * vs_now) * (within.x * within.y);
    vec2 inside = step(abs(vs_before - 0.5), vec2(0.5));
    vec4 before = texture(cloud_atlas, vs_frame.xy + vs_frame.zw * vs_before);
    texel = mix(before * (inside.x * inside.y), texel, vs_share.y);
#endif
#ifdef FLASHES
    // What the picture shows darker is darker in this light too.
    vec3 shown = min(texel.rgb / max(texel.a, 0.004), vec3(1.0));
    vec3 flash = vs_flash_color * flash_share(vs_flash_at, vs_from) + vs_others;
    // A root for the display's curve: exact where there is no flash.
    texel.rgb = sqrt(shown * shown + flash * (0.45 + 1.1 * shown.g)) * texel.a;
#endif
    color = vec4(texel.rgb * (1.0 - vs_haze.w) + vs_haze.rgb * texel.a, texel.a) * vs_share.x;
}
