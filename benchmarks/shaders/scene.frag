uniform vec3 color;

in vec3 vs_position;
out vec4 fragment;

void main()
{
    vec3 n = normalize(cross(dFdx(vs_position), dFdy(vs_position)));
    fragment = vec4(color * (0.7 + 0.3 * abs(n.y)), 1.0);
}
