// The box around an area's elliptical cylinder, its far sides; no vertex data.
#include <block:RainView>
#include <block:Veil>

// All linear in the ray, so interpolated exactly: the ray in world axes, and in the ellipse's own
// (in shares of its radii) with its products with the way from the ellipse's centre to the camera.
out vec3 vs_ray;
out vec4 vs_own;

vec2 to_ellipse(vec2 v)
{
    return vec2(v.x * veil_axis.z - v.y * veil_axis.w, v.x * veil_axis.w + v.y * veil_axis.z)
        / veil_shape.xy;
}

void main()
{
    // Strip of a box: the bits of three constants are its corners.
    int bit = 1 << gl_VertexID;
    vec3 c = vec3((0x287a & bit) != 0, (0x02af & bit) != 0, (0x31e3 & bit) != 0) * 2.0 - 1.0;
    vec2 u = c.xz * veil_shape.xy * 1.001;
    vec2 xz = veil_axis.xy
        + vec2(u.x * veil_axis.z + u.y * veil_axis.w, -u.x * veil_axis.w + u.y * veil_axis.z);
    vec3 p = vec3(xz.x, c.y > 0.0 ? veil_span.y : veil_span.x, xz.y);
    vs_ray = p - camera_position.xyz;
    vec2 o = to_ellipse(camera_position.xz - veil_axis.xy);
    vec2 r = to_ellipse(vs_ray.xz);
    vs_own = vec4(r, dot(o, r), o.x * r.y - o.y * r.x);
    gl_Position = view_projection * vec4(p, 1.0);
    gl_Position.z = 0.0;  // neither plane may cut it: the depth is compared in the fragment stage
}
