// One point for every splash whose crown stands, so that a primitive query tells how many there are.
layout(points) in;
layout(points, max_vertices = 1) out;
#include "splash.glsl"

in vec4 vs_form[];

void main()
{
    if (vs_form[0].x <= 0.0 || vs_form[0].y >= CROWN_LIFE) return;
    gl_Position = vec4(0.0);
    EmitVertex();
    EndPrimitive();
}
