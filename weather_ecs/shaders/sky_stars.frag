in vec3 vs_light;
out vec4 color;

void main()
{
    vec2 off = gl_PointCoord * 2.0 - 1.0;
    color = vec4(vs_light * max(1.0 - dot(off, off), 0.0) * 1.3, 1.0);
}
