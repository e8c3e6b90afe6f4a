// Expands a flake to face the camera.
layout(points) in;
#include "flake_shape.glsl"

in vec4 vs_place[];
in vec4 vs_axes[];
in vec4 vs_shown[];
noperspective out vec4 gs_all;  // place in the picture, -1 to 1; colour, packed
#ifdef FAR
layout(triangle_strip, max_vertices = 3) out;
#else
layout(triangle_strip, max_vertices = 4) out;
flat out vec3 gs_frame;  // layer, level, share of even white
#endif

void corner(vec2 at)
{
    vec2 place = vs_place[0].xy + vs_axes[0].xy * at.x + vs_axes[0].zw * at.y;
    gl_Position = vec4(place, vs_place[0].z, 1.0);
    gs_all = vec4(at, vs_shown[0].xy);
#ifndef FAR
    // Of a small picture the gaps between the arms are gone, and they must not make it pale.
    gs_frame = vec3(vs_shown[0].zw, smoothstep(0.5, 4.0, vs_shown[0].w));
#endif
    EmitVertex();
}

void main()
{
    float radius = vs_place[0].w;
    if (radius <= 0.0) return;
    bool square = is_square(radius);
    float reach = triangle_reach(radius);
    for (int i = 0; i < 3; ++i)
        corner(square ? vec2(i & 1, i >> 1) * 2.0 - 1.0 : reach * TRIANGLE[i]);
#ifndef FAR
    if (square) corner(vec2(1.0));
#endif
    EndPrimitive();
}
