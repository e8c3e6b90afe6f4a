// A streak: bright along its middle, darker towards the rim of the drop, soft at its ends.
in vec2 gs_uv;
flat in vec4 gs_color;
out vec4 color;

void main()
{
    float rim = gs_uv.x * gs_uv.x;
    if (rim > 1.0 || gs_uv.y > 1.0) discard;
    float ends = min(min(gs_uv.y * 3.0, (1.0 - gs_uv.y) * 6.0), 1.0);
    color = vec4(gs_color.rgb * (1.0 - 0.25 * rim), gs_color.a * (1.0 - 0.4 * rim) * ends);
}
