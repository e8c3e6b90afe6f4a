// Expands a streak to face the camera, with one triangle: setting up a second one would cost as much
// as all its pixels. What has no width is left out here.
layout(points) in;
layout(triangle_strip, max_vertices = 3) out;
#include "packed_color.glsl"
#include <block:RainView>

in vec4 vs_tail[];
in vec4 vs_head[];
in vec4 vs_color[];
in float vs_width[];
noperspective out vec4 gs_all;  // across and along the streak; colour, packed

// What the profile leaves of a quad, over what it leaves of the tapered triangle.
const float TAPERED = 0.8577;

void corner(vec3 at, vec2 off, vec2 uv, float strength)
{
    gl_Position = vec4(at.xy + off, at.z, 1.0);
    gs_all = vec4(uv, pack_color(vec4(vs_color[0].rgb, vs_color[0].a * strength)));
    EmitVertex();
}

void main()
{
    if (vs_width[0] <= 0.0) return;
    // In normalised device coordinates, where what runs along a triangle is linear.
    vec3 a = vs_tail[0].xyz / vs_tail[0].w;
    vec3 b = vs_head[0].xyz / vs_head[0].w;
    vec2 along = (b.xy - a.xy) * view_size.xy;
    float span = length(along);
    along = span > 1e-3 ? along / span : vec2(0.0, -1.0);
    vec2 across = vec2(-along.y, along.x) * vs_width[0] / view_size.xy;
    // A streak shorter than it is wide is a dot.
    vec2 longer = along * max(vs_width[0] - 0.5 * span, 0.0) / view_size.xy;
    a.xy -= longer;
    b.xy += longer;
    if (vs_width[0] < 1.5) {
        // Tapered, of the quad's area: at this width it is the same to the eye.
        corner(b, 2.0 * across, vec2(1.0, 1.0), TAPERED);
        corner(b, -2.0 * across, vec2(-1.0, 1.0), TAPERED);
        corner(a, vec2(0.0), vec2(0.0, 0.0), TAPERED);
    } else {
        // Around the quad, which the fragment shader cuts out.
        corner(a, across, vec2(1.0, 0.0), 1.0);
        corner(a, -3.0 * across, vec2(-3.0, 0.0), 1.0);
        corner(2.0 * b - a, across, vec2(1.0, 2.0), 1.0);
    }
    EndPrimitive();
}
