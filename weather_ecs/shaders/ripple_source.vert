// The craters that an impact makes, if it hit this water in this step; as physics/ripple.craters.
#include "impact.glsl"
#include "hash.glsl"
#include "ripple_grid.glsl"

out vec2 vs_cell;    // column and row of the first, 0.5 in the first cell
out float vs_depth;  // mm, of each
out float vs_number; // of them
flat out uint vs_word;

const float DEPTH = 0.12;
const float SHALLOWEST = 5.0;
const float DEEPEST = 10.0;
const float COMMON = 6.0;
const float MOST_CRATERS = 5.0;
const float ON_SURFACE = 0.05;

void main()
{
    gl_Position = vec4(0.0);
    vs_cell = vec2(0.0);
    vs_depth = vs_number = 0.0;
    vs_word = 0u;
    Impact i;
    if (!read_impact(i) || i.age < ripple_law.z || i.age >= ripple_law.w) return;
    if (abs(i.position.y - ripple_cells.w) > ON_SURFACE) return;
    vec2 own = to_water(i.position.xz);
    vec2 off = abs(own - ripple_window.xy);
    if (off.x >= ripple_window.z || off.y >= ripple_window.w) return;
    if (ripple_body.z > 0.0 && !in_ellipse(own)) return;
    vec2 cell = own / ripple_cells.z + 0.5 * ripple_cells.xy;
    vs_cell = cell;
    uvec2 spot = uvec2(ivec2(floor(i.position.xz * 64.0)));
    vs_word = hash_word(spot.x) ^ spot.y;
    float deep = DEPTH * i.diameter * sqrt(i.diameter) * i.speed * sqrt(i.weight);
    float share = deep / SHALLOWEST;
    if (hash_unit(vs_word) >= share * share) return;
    float many = deep / COMMON;
    vs_number = clamp(floor(many * many), 1.0, MOST_CRATERS);
    vs_depth = clamp(deep * inversesqrt(vs_number), SHALLOWEST, DEEPEST);
}
