// Expands a flake to face the camera, drawn out along its way, with one triangle around its quad.
layout(points) in;
layout(triangle_strip, max_vertices = 3) out;
#include <block:RainView>

in vec4 vs_head[];
in vec4 vs_path[];
in vec4 vs_color[];
in vec4 vs_turn[];
out vec2 gs_uv;         // along and across the way, -1 to 1 on the flake
flat out vec4 gs_color;
flat out vec4 gs_turn;
flat out vec2 gs_frame; // layer; share of the length over which the ends fade

void corner(vec3 at, vec2 along, vec2 across, vec2 uv)
{
    gl_Position = vec4(at.xy + along * uv.x + across * uv.y, at.z, 1.0);
    gs_uv = uv;
    gs_color = vs_color[0];
    gs_turn = vs_turn[0];
    EmitVertex();
}

void main()
{
    float radius = vs_path[0].z;
    if (radius <= 0.0) return;
    vec2 way = vs_path[0].xy;
    float span = length(way);
    vec2 e = span > 0.5 ? way / span : vec2(1.0, 0.0);
    vec3 at = vs_head[0].xyz / vs_head[0].w;
    at.xy -= way / view_size.xy;  // the middle of the way
    float longer = radius + 0.5 * span;
    vec2 along = 2.0 * longer * e / view_size.xy;
    vec2 across = 2.0 * radius * vec2(-e.y, e.x) / view_size.xy;
    gs_frame = vec2(vs_path[0].w, radius / longer);
    // The picture keeps its turn however the flake moves, as long as it is not drawn out.
    corner(at, along, across, vec2(-1.0, -1.0));
    corner(at, along, across, vec2(3.0, -1.0));
    corner(at, along, across, vec2(-1.0, 3.0));
    EndPrimitive();
}
