// A canvas of near clouds in the picture, at the depth of the plane that is before them all.
uniform vec3 canvas_depth;  // by x, by y, in the middle
uniform vec4 canvas_rectangle;

out vec2 vs_uv;

void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 p = mix(canvas_rectangle.xy, canvas_rectangle.zw, corner);
    vs_uv = p * 0.5 + 0.5;
    gl_Position = vec4(p, dot(vec3(p, 1.0), canvas_depth), 1.0);
}
