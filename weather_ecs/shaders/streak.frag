// A streak: bright along its middle, darker towards the rim of the drop, soft at its ends.
#include "packed_color.glsl"

noperspective in vec4 gs_all;
out vec4 color;

void main()
{
    float rim = gs_all.x * gs_all.x;
    float along = gs_all.y;
    if (rim > 1.0 || along > 1.0) discard;
    float ends = min(min(along * 3.0, (1.0 - along) * 6.0), 1.0);
    vec4 own = unpack_color(gs_all.zw);
    color = vec4(own.rgb * (1.0 - 0.25 * rim), own.a * (1.0 - 0.4 * rim) * ends);
}
