// Water of a splash, how much of it and how bright: one frame of the animated texture.
uniform sampler2DArray splash_frames;

in vec2 gs_uv;
flat in float gs_layer;
flat in vec4 gs_color;
out vec4 color;

void main()
{
#ifdef SMALL
    if (max(gs_uv.x, gs_uv.y) > 1.0) discard;
#endif
    vec2 water = texture(splash_frames, vec3(gs_uv, gs_layer)).rg;
    color = vec4(gs_color.rgb * (0.5 + 0.7 * water.g), gs_color.a * water.r);
}
