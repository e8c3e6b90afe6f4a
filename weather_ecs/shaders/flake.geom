// Expands a flake to face the camera, drawn out along its way: a large one to the square of its
// picture, a small one to a triangle of about its area, which costs half as much as one around it.
layout(points) in;
#include "packed_color.glsl"
#include <block:RainView>

in vec4 vs_head[];
in vec4 vs_path[];
in vec4 vs_color[];
in vec4 vs_turn[];
noperspective out vec4 gs_all;  // place in the picture, -1 to 1; colour, packed
#ifdef FAR
layout(triangle_strip, max_vertices = 3) out;
#else
layout(triangle_strip, max_vertices = 4) out;
flat out vec4 gs_frame;  // layer, level, how much denser, share of even white
const float LARGE = 2.5;  // pixels, radius from which on it shows what a triangle cuts off
#endif

vec3 middle;
vec2 along;
vec2 across;
float opacity;

void corner(vec2 at)
{
    // From the picture, turned and tilted, to the flake as it is drawn out along its way.
    vec2 uv = vec2(at.x, at.y * vs_turn[0].z);
    vec2 turn = vs_turn[0].xy;
    uv = vec2(uv.x * turn.x - uv.y * turn.y, uv.x * turn.y + uv.y * turn.x);
    gl_Position = vec4(middle.xy + along * uv.x + across * uv.y, middle.z, 1.0);
    gs_all = vec4(at, pack_color(vec4(vs_color[0].rgb, opacity)));
#ifndef FAR
    // Of a small picture the gaps between the arms are gone, and they must not make it pale.
    float small = smoothstep(0.5, 4.0, vs_turn[0].w);
    gs_frame = vec4(vs_path[0].w, vs_turn[0].w, mix(1.0, 4.0, small), small);
#endif
    EmitVertex();
}

void main()
{
    float radius = vs_path[0].z;
    if (radius <= 0.0) return;
    vec2 way = vs_path[0].xy;
    float span = length(way);
    vec2 e = span > 0.5 ? way / span : vec2(1.0, 0.0);
    middle = vs_head[0].xyz / vs_head[0].w;
    middle.xy -= way / view_size.xy;  // the middle of the way
    along = 2.0 * (radius + 0.5 * span) * e / view_size.xy;
    across = 2.0 * radius * vec2(-e.y, e.x) / view_size.xy;
    opacity = vs_color[0].a;
#ifndef FAR
    if (radius >= LARGE) {
        corner(vec2(-1.0, -1.0));
        corner(vec2(1.0, -1.0));
        corner(vec2(-1.0, 1.0));
        corner(vec2(1.0, 1.0));
        EndPrimitive();
        return;
    }
#endif
    // The smallest lose a little at three sides, and have it back all over.
    float k = mix(1.76, 2.1, clamp((radius - 1.0) * 0.8, 0.0, 1.0));
    opacity *= 1.078 - 0.262 * (k - 1.76);
    corner(k * vec2(0.0, 1.0));
    corner(k * vec2(-0.8660254, -0.5));
    corner(k * vec2(0.8660254, -0.5));
    EndPrimitive();
}
