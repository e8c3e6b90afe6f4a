// A flake: its picture, turned and foreshortened, blurred by its motion and where out of focus.
uniform sampler2DArray flake_pictures;

in vec2 gs_uv;
flat in vec4 gs_color;
flat in vec4 gs_turn;
flat in vec2 gs_frame;
out vec4 color;

void main()
{
    if (max(abs(gs_uv.x), abs(gs_uv.y)) > 1.0) discard;
    vec2 at = vec2(gs_uv.x * gs_turn.x + gs_uv.y * gs_turn.y,
                   (gs_uv.y * gs_turn.x - gs_uv.x * gs_turn.y) * gs_turn.z);
    vec2 seen = textureLod(flake_pictures, vec3(at * 0.5 + 0.5, gs_frame.x), gs_turn.w).rg;
    // The smallest pictures are even squares: their corners are cut off, as are blurred ones'.
    float r2 = dot(at, at);
    // Of a small picture the gaps between the arms are gone, and they must not make it pale.
    float small = smoothstep(0.5, 4.0, gs_turn.w);
    float cover = min(seen.r * mix(1.0, 4.0, small), 1.0);
    cover *= smoothstep(1.35, 0.6, r2);
    color = vec4(gs_color.rgb * mix(seen.g, 1.0, small), gs_color.a * cover);
}
