// A rectangle of the picture, and the view rays through it; no vertex data.
#include <block:Veil>
#include "veil_axes.glsl"

// Linear in the picture: 1 long along the camera's forward axis, world axes.
noperspective out vec3 vs_ray;
noperspective out vec2 vs_place;  // in the picture, 0 to 1
#ifdef ALONE
noperspective out vec4 vs_own;    // of the only area: see on_axes
noperspective out float vs_rise;  // of the way up to its ceiling, for 1 of depth
#endif

void main()
{
    vec2 at = mix(veil_frame.xy, veil_frame.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    vs_ray = veil_rays[0].xyz + at.x * veil_rays[1].xyz + at.y * veil_rays[2].xyz;
    vs_place = at * 0.5 + 0.5;
#ifdef ALONE
    vs_own = on_axes(0, vs_ray);
    vs_rise = vs_ray.y / max(veil_load[0].z, 1e-3);
#endif
    // By a depth test the pixels are told apart in which the scene is farther off, or empty.
    gl_Position = vec4(at, veil_place.x, 1.0);
}
