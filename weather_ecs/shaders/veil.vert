// A rectangle of the picture, and the view rays through it; no vertex data.
#include <block:RainView>
#include <block:Veil>
#include "veil_axes.glsl"

// Linear in the picture: 1 long along the camera's forward axis, world axes.
noperspective out vec3 vs_ray;
noperspective out vec2 vs_place;  // in the picture, 0 to 1
#ifdef ALONE
noperspective out vec4 vs_own;    // of the only area: see on_axes
noperspective out float vs_rise;  // of the way up to its ceiling, for 1 of depth
flat out vec4 vs_load;
flat out vec4 vs_shown;
flat out vec4 vs_tint;
flat out vec4 vs_fog;
#ifdef CURTAIN
flat out vec4 vs_curtain;
#endif
#endif

void main()
{
    vec2 at = mix(veil_frame.xy, veil_frame.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    vs_ray = veil_rays[0].xyz + at.x * veil_rays[1].xyz + at.y * veil_rays[2].xyz;
    vs_place = at * 0.5 + 0.5;
#ifdef ALONE
    vs_own = on_axes(0, vs_ray);
    vs_rise = vs_ray.y / max(veil_load[0].z, 1e-3);
    vs_load = vec4(veil_load[0].x, veil_from[0].z, veil_load[0].zw);
    vs_shown = vec4(veil_shown[0].xy, view_depth.xy);
    vs_tint = veil_tint[0];
    vs_fog = vec4(fog_shown.rgb, fog_color.w);
#ifdef CURTAIN
    vs_curtain = veil_curtain[0];
#endif
#endif
    // By a depth test the pixels are told apart in which the scene is farther off, or empty.
    gl_Position = vec4(at, veil_place.x, 1.0);
}
