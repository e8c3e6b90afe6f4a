// Lists the numbers of the drops in view, in their own order. Four drops at a time, as they are to be
// had together: to be handed a drop costs more than to look at it. APART: flakes of a few pixels by a
// list of their own.
#ifdef APART
#extension GL_ARB_gpu_shader5 : require
#endif
layout(lines_adjacency) in;
layout(points, max_vertices = 4) out;

in float vs_seen[];
#ifdef APART
layout(stream = 0) out uint seen;
layout(stream = 1) out uint seen_small;
#else
out uint seen;
#endif

void main()
{
    for (int i = 0; i < 4; ++i) {
        uint id = uint(gl_PrimitiveIDIn * 4 + i);
#ifdef APART
        if (vs_seen[i] == 1.0) {
            seen = id;
            EmitStreamVertex(0);
        } else if (vs_seen[i] == 2.0) {
            seen_small = id;
            EmitStreamVertex(1);
        }
#else
        if (vs_seen[i] > 0.0) {
            seen = id;
            EmitVertex();
        }
#endif
    }
}
