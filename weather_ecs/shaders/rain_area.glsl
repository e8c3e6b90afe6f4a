// How much of an area's rain falls at p = (x, z): 0 outside the ellipse, 1 inside its soft edge.
// axis = (centre x, centre z, cos heading, sin heading), shape = (a, b, soft edge, ceiling).
// The distance to the perimeter is of first order: exact on the axes and for circles.
float area_factor(vec2 p, vec4 axis, vec4 shape)
{
    vec2 e = p - axis.xy;
    vec2 u = vec2(e.x * axis.z - e.y * axis.w, e.x * axis.w + e.y * axis.z);
    vec2 g = u / shape.xy;
    float f = dot(g, g);
    if (f >= 1.0) return 0.0;
    if (shape.z <= 0.0) return 1.0;
    float rho = sqrt(f);
    float inside = (1.0 - rho) * rho / max(length(g / shape.xy), 1e-12);
    return f < 1e-9 ? 1.0 : smoothstep(0.0, shape.z, inside);
}
