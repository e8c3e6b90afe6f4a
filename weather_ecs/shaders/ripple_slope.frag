// Rises along the surface's own axes from cell to cell but one (Sobel's, which do not see a single
// cell that stands out), twice: the colour mask chooses the half of the map that is written, so
// that the other keeps those of a step before. What is drawn lies between them. 127 of 255 is
// level, the range is GREATEST; see ripple_sample.glsl.
#include "ripple_grid.glsl"

uniform sampler2D amplitude;  // repeated over its edges, mm

out vec4 rises;

const float GREATEST = 14.0;  // mm

void main()
{
    vec2 uv = gl_FragCoord.xy / ripple_cells.xy;
    vec3 low = vec3(textureLodOffset(amplitude, uv, 0.0, ivec2(-1, -1)).r,
                    textureLodOffset(amplitude, uv, 0.0, ivec2(0, -1)).r,
                    textureLodOffset(amplitude, uv, 0.0, ivec2(1, -1)).r);
    vec3 high = vec3(textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 1)).r,
                     textureLodOffset(amplitude, uv, 0.0, ivec2(0, 1)).r,
                     textureLodOffset(amplitude, uv, 0.0, ivec2(1, 1)).r);
    float left = textureLodOffset(amplitude, uv, 0.0, ivec2(-1, 0)).r;
    float right = textureLodOffset(amplitude, uv, 0.0, ivec2(1, 0)).r;
    const vec3 share = vec3(0.25, 0.5, 0.25);
    vec2 rise = vec2(0.25 * (low.z - low.x + high.z - high.x) + 0.5 * (right - left),
                     dot(high - low, share));
    rises = ((127.0 + rise * (127.0 / GREATEST)) / 255.0).xyxy;
}
