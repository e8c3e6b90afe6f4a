// A flake: its picture, blurred by its motion and where out of focus. FAR: of a few pixels, a soft
// disc, which is what its picture comes to then.
#include "packed_color.glsl"

noperspective in vec4 gs_all;
out vec4 color;
#ifndef FAR
uniform sampler2DArray flake_pictures;
flat in vec3 gs_frame;
#endif

void main()
{
    // The smallest pictures are even squares: their corners are cut off, as are blurred ones'.
    float cover = clamp(1.8 - 1.3333 * dot(gs_all.xy, gs_all.xy), 0.0, 1.0);
    vec4 own = unpack_color(gs_all.zw);
#ifdef FAR
    color = vec4(own.rgb, own.a * cover);
#else
    vec2 seen = textureLod(flake_pictures, vec3(gs_all.xy * 0.5 + 0.5, gs_frame.x), gs_frame.y).rg;
    cover *= min(seen.r * (1.0 + 3.0 * gs_frame.z), 1.0);
    color = vec4(own.rgb * mix(seen.g, 1.0, gs_frame.z), own.a * cover);
#endif
}
