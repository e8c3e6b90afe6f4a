// Counts the times of listed impacts from another moment; see gpu/impact_times.py.
layout(local_size_x = 64) in;

layout(std430, binding = 3) buffer Impacts { vec4 impacts[]; };  // three a record

uniform float impact_shift;  // s

void main()
{
    uint k = gl_GlobalInvocationID.x * 3u;
    if (k < uint(impacts.length())) impacts[k].w -= impact_shift;
}
