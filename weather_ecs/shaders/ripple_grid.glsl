// The grid of one water surface. Its own axes, in metres from its middle: u along, w across.
#include <block:RippleGrid>

vec2 to_water(vec2 xz)
{
    vec2 d = xz - ripple_frame.xy;
    return vec2(d.x * ripple_frame.z - d.y * ripple_frame.w,
                d.x * ripple_frame.w + d.y * ripple_frame.z);
}

bool in_ellipse(vec2 own)
{
    vec2 share = own / ripple_body.xy;
    return dot(share, share) < 1.0;
}
