uniform vec4 inside_color;  // premultiplied, encoded

out vec4 color;

void main()
{
    color = inside_color;
}
