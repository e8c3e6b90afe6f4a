// Expands a streak to a quad that faces the camera; what has no width is left out here.
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
#include <block:RainView>

in vec4 vs_tail[];
in vec4 vs_head[];
in vec4 vs_color[];
in float vs_width[];
out vec2 gs_uv;
out vec4 gs_color;

void corner(vec4 at, vec2 off, vec2 uv)
{
    gl_Position = vec4(at.xy + off * at.w, at.zw);
    gs_uv = uv;
    gs_color = vs_color[0];
    EmitVertex();
}

void main()
{
    if (vs_width[0] <= 0.0) return;
    vec4 a = vs_tail[0];
    vec4 b = vs_head[0];
    vec2 along = (b.xy / b.w - a.xy / a.w) * view_size.xy;
    float span = length(along);
    along = span > 1e-3 ? along / span : vec2(0.0, -1.0);
    vec2 across = vec2(-along.y, along.x) * vs_width[0] / view_size.xy;
    // A streak shorter than it is wide is a dot.
    vec2 longer = along * max(vs_width[0] - 0.5 * span, 0.0) / view_size.xy;
    corner(vec4(a.xy - longer * a.w, a.zw), across, vec2(1.0, 0.0));
    corner(vec4(a.xy - longer * a.w, a.zw), -across, vec2(-1.0, 0.0));
    corner(vec4(b.xy + longer * b.w, b.zw), across, vec2(1.0, 1.0));
    corner(vec4(b.xy + longer * b.w, b.zw), -across, vec2(-1.0, 1.0));
    EndPrimitive();
}
