// One step of the amplitudes a: physics/ripple.py is the oracle, symbol for symbol.
#include "ripple_grid.glsl"

uniform sampler2D amplitude;         // a(t), repeated over its edges
uniform sampler2D amplitude_before;  // a(t - 1)

out float following;

void main()
{
    vec2 p = gl_FragCoord.xy;
    vec2 uv = p / ripple_cells.xy;
    float low = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, -1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(0, -1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, -1)).r;
    float level = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 0)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, 0)).r;
    float high = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(0, 1)).r
        + textureLodOffset(amplitude, uv, 0.0, ivec2(1, 1)).r;
    float before = textureLod(amplitude_before, uv, 0.0).r;
    float a = ((low + level + high) * 0.25 - before) * ripple_law.x;

    bvec2 rim = lessThan(min(p, ripple_cells.xy - p), vec2(1.0));
    bool held = (rim.x && ripple_hold.x > 0.0) || (rim.y && ripple_hold.y > 0.0);
    vec2 own = (p - 0.5 * ripple_cells.xy) * ripple_cells.z;
    held = held || (ripple_hold.z > 0.0 && !in_ellipse(own));
    following = held || abs(a) < ripple_law.y ? 0.0 : a;
}
