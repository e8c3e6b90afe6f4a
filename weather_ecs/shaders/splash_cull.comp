// Lists the impacts whose splash is to be seen, in the order of the records, so that only these are
// drawn: apart those that are no more than a crown of a few pixels. A work group takes a chunk of
// 4096 records, a thread 32 in a row; each chunk has its own stretch of both lists and its own draw
// command for each, those of the large ones after all the others.
layout(local_size_x = 128) in;
#define IMPACT_RECORDS
#include "splash_seen.glsl"

layout(std430, binding = 4) writeonly buffer Shown { uint shown[]; };
struct DrawElements { uint count; uint instances; uint first; int base_vertex; uint base_instance; };
layout(std430, binding = 5) writeonly buffer Commands { DrawElements commands[]; };

const uint ROW = 32u;
const float SMALL = 5.0;  // pixels, radius of a crown that is drawn with one triangle
shared uvec2 found[128];

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint first = gl_GlobalInvocationID.x * ROW;
    uint records = uint(impacts.length()) / 3u;
    uvec2 mask = uvec2(0u);  // small, large
    for (uint k = 0u; k < ROW; ++k) {
        Impact i;
        Seen s;
        if (first + k >= records || !read_impact(first + k, i) || !splash_seen(i, s)) continue;
        if (s.detail < FAINTEST && s.pixels < SMALL) mask.x |= 1u << k;
        else mask.y |= 1u << k;
    }
    found[thread] = uvec2(bitCount(mask));
    barrier();
    uvec2 at = uvec2(0u);
    uvec2 total = uvec2(0u);
    for (uint k = 0u; k < 128u; ++k) {
        if (k == thread) at = total;
        total += found[k];
    }
    // Each chunk's stretch is as long as the chunk: the small ones from its start, the large after.
    uint start = gl_WorkGroupID.x * 128u * ROW;
    uint to = start + at.x;
    for (uint rest = mask.x; rest != 0u; rest &= rest - 1u)
        shown[to++] = first + uint(findLSB(rest));
    to = start + total.x + at.y;
    for (uint rest = mask.y; rest != 0u; rest &= rest - 1u)
        shown[to++] = first + uint(findLSB(rest));
    if (thread > 0u) return;
    uint chunk = gl_WorkGroupID.x;
    commands[chunk] = DrawElements(total.x, 1u, start, 0, 0u);
    commands[gl_NumWorkGroups.x + chunk] = DrawElements(total.y, 1u, start + total.x, 0, 0u);
}
