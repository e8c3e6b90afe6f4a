// A triangle over a canvas, cut off where its guard is beyond the far plane: no scene is beyond it there.
uniform sampler2D scene_depth;
uniform vec3 canvas_depth;  // by x, by y, in the middle; -1 to 1
uniform float canvas_factor;  // pixels of the picture on a side of one of the canvas

out vec2 vs_at;  // in the scene's depth
out float vs_guard;  // 0 to 1
flat out vec2 vs_reach;

void main()
{
    vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    vs_at = p * 0.5 + 0.5;
    float depth = dot(vec3(p, 1.0), canvas_depth);
    vs_guard = depth * 0.5 + 0.5;
    vs_reach = canvas_factor / vec2(textureSize(scene_depth, 0));
    // The same beyond the far plane, but not cut off where the guard is before the near one.
    gl_Position = vec4(p, 1.0 - 0.001 * (1.0 - depth), 1.0);
}
