// Rises along the surface's own axes from cell to cell but one, twice: the colour mask chooses the
// half of the map that is written, so that the other keeps those of a step before. What is drawn
// lies between them. 127 of 255 is level, the range is GREATEST; see ripple_sample.glsl.
#include "ripple_grid.glsl"

uniform sampler2D amplitude;  // repeated over its edges, mm

out vec4 rises;

const float GREATEST = 16.0;  // mm

void main()
{
    vec2 uv = gl_FragCoord.xy / ripple_cells.xy;
    float left = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 0)).r;
    float right = textureLodOffset(amplitude, uv, 0.0, ivec2(1, 0)).r;
    float low = textureLodOffset(amplitude, uv, 0.0, ivec2(0, -1)).r;
    float high = textureLodOffset(amplitude, uv, 0.0, ivec2(0, 1)).r;
    vec2 rise = vec2(right - left, high - low);
    rises = ((127.0 + rise * (127.0 / GREATEST)) / 255.0).xyxy;
}
