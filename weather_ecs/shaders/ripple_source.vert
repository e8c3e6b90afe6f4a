// The crater that an impact makes, if it hit this water in this step; as physics/ripple.craters.
#include "impact.glsl"
#include "hash.glsl"
#include "ripple_grid.glsl"

out vec2 vs_cell;    // column and row, 0.5 in the first cell
out float vs_depth;  // mm; 0 where there is none

const float DEPTH = 0.12;
const float SHALLOWEST = 5.0;
const float DEEPEST = 10.0;
const float ON_SURFACE = 0.05;

float crater_depth(Impact i)
{
    float deep = DEPTH * i.diameter * sqrt(i.diameter) * i.speed * sqrt(i.weight);
    uvec2 spot = uvec2(ivec2(floor(i.position.xz * 64.0)));
    uint word = hash_word(spot.x) ^ spot.y;
    float share = deep / SHALLOWEST;
    return hash_unit(word) < share * share ? clamp(deep, SHALLOWEST, DEEPEST) : 0.0;
}

void main()
{
    gl_Position = vec4(0.0);
    vs_cell = vec2(0.0);
    vs_depth = 0.0;
    Impact i;
    if (!read_impact(i) || i.age < ripple_law.z || i.age >= ripple_law.w) return;
    if (abs(i.position.y - ripple_cells.w) > ON_SURFACE) return;
    vec2 own = to_water(i.position.xz);
    vec2 off = abs(own - ripple_window.xy);
    if (off.x >= ripple_window.z || off.y >= ripple_window.w) return;
    if (ripple_body.z > 0.0 && !in_ellipse(own)) return;
    vec2 cell = own / ripple_cells.z + 0.5 * ripple_cells.xy;
    // Where a border is not held, the grid goes round.
    vs_cell = mix(cell - ripple_cells.xy * floor(cell / ripple_cells.xy), cell, ripple_hold.xy);
    vs_depth = crater_depth(i);
}
