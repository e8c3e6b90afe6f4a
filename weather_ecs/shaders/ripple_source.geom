// The square of cells that a crater covers, once more beyond each edge that it reaches over.
layout(points) in;
layout(triangle_strip, max_vertices = 16) out;
#include "ripple_grid.glsl"

in vec2 vs_cell[];
in float vs_depth[];
out vec2 gs_off;     // cells from the crater's middle
out float gs_depth;

const float SPREAD = 5.0;

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

void main()
{
    if (vs_depth[0] <= 0.0) return;
    vec2 cell = vs_cell[0];
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
