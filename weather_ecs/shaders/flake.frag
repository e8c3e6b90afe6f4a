// A flake: its picture, blurred by its motion and where out of focus. FAR: of a few pixels, a soft
// disc, which is what its picture comes to then.
in vec2 gs_at;
flat in vec4 gs_color;
out vec4 color;
#ifndef FAR
uniform sampler2DArray flake_pictures;
flat in vec4 gs_frame;
#endif

void main()
{
    // The smallest pictures are even squares: their corners are cut off, as are blurred ones'.
    float cover = clamp(1.8 - 1.3333 * dot(gs_at, gs_at), 0.0, 1.0);
#ifdef FAR
    color = vec4(gs_color.rgb, gs_color.a * cover);
#else
    vec2 seen = textureLod(flake_pictures, vec3(gs_at * 0.5 + 0.5, gs_frame.x), gs_frame.y).rg;
    cover *= min(seen.r * gs_frame.z, 1.0);
    color = vec4(gs_color.rgb * mix(seen.g, 1.0, gs_frame.w), gs_color.a * cover);
#endif
}
