// One step of the amplitudes a: physics/ripple.py is the oracle, symbol for symbol.
#include "ripple_grid.glsl"

uniform sampler2D amplitude;  // a(t), repeated over its edges
uniform sampler2D amplitude_before;  // a(t - 1)

out float following;

void main()
{
    vec2 p = gl_FragCoord.xy;
    following = 0.0;
    bvec2 rim = lessThan(min(p, ripple_cells.xy - p), vec2(1.0));
    if ((rim.x && ripple_hold.x > 0.0) || (rim.y && ripple_hold.y > 0.0)) return;
    if (ripple_hold.z > 0.0 && !in_ellipse((p - 0.5 * ripple_cells.xy) * ripple_cells.z)) return;
    vec2 uv = p / ripple_cells.xy;
    float low = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, -1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(0, -1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, -1)).r;
    float level = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 0)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, 0)).r;
    float high = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(0, 1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, 1)).r;
    float before = texelFetch(amplitude_before, ivec2(p), 0).r;
    float a = ((low + level + high) * 0.25 - before) * ripple_law.x;
    following = abs(a) < ripple_law.y ? 0.0 : a;
}
