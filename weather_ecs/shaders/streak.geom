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

void main()
{
    if (vs_width[0] <= 0.0) return;
    // In normalised device coordinates, where what runs along a triangle is linear.
    vec3 a = vs_tail[0].xyz / vs_tail[0].w;
    vec3 b = vs_head[0].xyz / vs_head[0].w;
    vec2 along = (b.xy - a.xy) * view_size.xy;
    float span = length(along);
    along = span > 1e-3 ? along / span : vec2(0.0, -1.0);
    vec3 across = vec3(vec2(-along.y, along.x) * vs_width[0] / view_size.xy, 0.0);
    // A streak shorter than it is wide is a dot.
    vec2 longer = along * max(vs_width[0] - 0.5 * span, 0.0) / view_size.xy;
    a.xy -= longer;
    b.xy += longer;
    // Tapered, of the quad's area: at this width it is the same to the eye. Or around the quad, which
    // the fragment shader cuts out. One way through for both, as a compiler for vectors takes all.
    bool thin = vs_width[0] < 1.5;
    vec3[3] at = vec3[3](thin ? b + 2.0 * across : a + across,
                         thin ? b - 2.0 * across : a - 3.0 * across,
                         thin ? a : 2.0 * b - a + across);
    vec2[3] uv = vec2[3](vec2(1.0, thin ? 1.0 : 0.0),
                         thin ? vec2(-1.0, 1.0) : vec2(-3.0, 0.0),
                         thin ? vec2(0.0) : vec2(1.0, 2.0));
    vec2 shown = pack_color(vs_color[0] * vec4(1.0, 1.0, 1.0, thin ? TAPERED : 1.0));
    for (int i = 0; i < 3; ++i) {
        gl_Position = vec4(at[i], 1.0);
        gs_all = vec4(uv[i], shown);
        EmitVertex();
    }
    EndPrimitive();
}
