// A canvas of near clouds; premultiplied, encoded.
uniform sampler2D cloud_canvas;

in vec2 vs_uv;
out vec4 color;

void main()
{
    color = texture(cloud_canvas, vs_uv);
}
