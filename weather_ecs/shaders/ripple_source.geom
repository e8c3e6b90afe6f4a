// The squares of cells that craters cover, once more beyond each edge that they reach over.
layout(points) in;
layout(triangle_strip, max_vertices = 80) out;
#include "ripple_grid.glsl"
#include "hash.glsl"

in vec2 vs_cell[];
in float vs_depth[];
in float vs_number[];
flat in uint vs_word[];
out vec2 gs_off;     // cells from the crater's middle
out float gs_depth;

const float SPREAD = 5.0;
const float SCATTER = 0.5;
const int MOST_CRATERS = 5;

void square(vec2 middle)
{
    for (int k = 0; k < 4; ++k) {
        gs_off = (vec2(k & 1, k >> 1) * 2.0 - 1.0) * SPREAD;
        gs_depth = vs_depth[0];
        gl_Position = vec4((middle + gs_off) / ripple_cells.xy * 2.0 - 1.0, 0.0, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}

// Crater k's place, in cells off the first.
vec2 aside(int k)
{
    if (k == 0) return vec2(0.0);
    uint own = hash_word(vs_word[0] + 0x9E3779B9u * uint(k));
    float turn = 6.28318531 * hash_unit(own ^ 0x27D4EB2Fu);
    float off = SCATTER * sqrt(hash_unit(own ^ 0x85EBCA6Bu));
    return vec2(cos(turn), sin(turn)) * (off / ripple_cells.z);
}

void crater(vec2 cell)
{
    // Where a border is not held, the grid goes round.
    cell -= ripple_cells.xy * floor(cell / ripple_cells.xy) * (1.0 - ripple_hold.xy);
    // Towards the twin beyond the nearer edge.
    vec2 twin = vec2(cell.x < 0.5 * ripple_cells.x ? ripple_cells.x : -ripple_cells.x,
                     cell.y < 0.5 * ripple_cells.y ? ripple_cells.y : -ripple_cells.y);
    bool beside = ripple_hold.x == 0.0 && min(cell.x, ripple_cells.x - cell.x) < SPREAD;
    bool behind = ripple_hold.y == 0.0 && min(cell.y, ripple_cells.y - cell.y) < SPREAD;
    square(cell);
    if (beside) square(cell + vec2(twin.x, 0.0));
    if (behind) square(cell + vec2(0.0, twin.y));
    if (beside && behind) square(cell + twin);
}

void main()
{
    for (int k = 0; k < MOST_CRATERS; ++k) {
        if (float(k) >= vs_number[0]) break;
        crater(vs_cell[0] + aside(k));
    }
}
