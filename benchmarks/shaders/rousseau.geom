// A streak as a quad that faces the camera; what is out of view ends here.
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

uniform mat4 view_projection;
uniform vec3 eye;
uniform vec3 wind;
uniform float exposure;  // s
uniform float width;     // factor on the drop's diameter
uniform float size;      // factor on the whole streak

in vec3 vs_position[];
in vec4 vs_drop[];
out vec2 gs_uv;           // across in [-1, 1], along in [0, 1]
flat out vec2 gs_center;  // where the drop's own direction lies in the scene texture

void main()
{
    vec3 path = (wind - vec3(0.0, vs_drop[0].x, 0.0)) * (exposure * size);
    vec4 head = gl_in[0].gl_Position;
    vec4 tail = head - view_projection * vec4(path, 0.0);
    if (min(head.w, tail.w) < 0.1) return;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    if (any(greaterThan(min(h, t), vec2(1.02))) || any(lessThan(max(h, t), vec2(-1.02)))) return;

    vec3 across = normalize(cross(path, eye - vs_position[0])) * (0.5 * width * size * vs_drop[0].y);
    vec4 side = view_projection * vec4(across, 0.0);
    // The screen spans the middle of what the wide-angle capture holds.
    gs_center = 0.5 + 0.18 * h;
    gl_Position = head - side;
    gs_uv = vec2(-1.0, 0.0);
    EmitVertex();
    gs_center = 0.5 + 0.18 * h;
    gl_Position = head + side;
    gs_uv = vec2(1.0, 0.0);
    EmitVertex();
    gs_center = 0.5 + 0.18 * h;
    gl_Position = tail - side;
    gs_uv = vec2(-1.0, 1.0);
    EmitVertex();
    gs_center = 0.5 + 0.18 * h;
    gl_Position = tail + side;
    gs_uv = vec2(1.0, 1.0);
    EmitVertex();
    EndPrimitive();
}
