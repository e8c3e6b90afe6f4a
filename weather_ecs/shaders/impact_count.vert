// Which vertices hold an impact of the frame that has just been simulated.
#include "impact.glsl"

out float vs_counts;

void main()
{
    Impact i;
    vs_counts = read_impact(i) && i.age < view_time.y ? 1.0 : 0.0;
    gl_Position = vec4(0.0);
}
