#version 330 core
// A line with soft sides.
in vec4 vs_color;
in float vs_across;
in float vs_half;
out vec4 color;

void main()
{
    float cover = clamp(vs_half + 0.5 - abs(vs_across), 0.0, 1.0) * min(2.0 * vs_half, 1.0);
    color = vec4(vs_color.rgb, vs_color.a * cover);
}
