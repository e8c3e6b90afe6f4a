// One point for every impact that counts, so that a primitive query tells how many there are.
layout(points) in;
layout(points, max_vertices = 1) out;

in float vs_counts[];

void main()
{
    if (vs_counts[0] < 0.5) return;
    gl_Position = vec4(0.0);
    EmitVertex();
    EndPrimitive();
}
