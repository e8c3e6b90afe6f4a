in vec3 vs_light;
out vec4 color;

void main()
{
    color = vec4(vs_light, 1.0);
}
