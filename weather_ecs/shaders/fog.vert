// One triangle over the whole target; its rays, 1 long along the camera's forward axis.
#include <block:RainView>
#include <block:FogView>

// To the right, upwards in the picture: linear over it, as the place in the depth's copy and the
// rays' rise in the world are. The rise is in units of the law's that belongs to the sky.
noperspective out vec2 vs_ray;
noperspective out vec2 vs_place;
noperspective out float vs_rise;
flat out vec3 vs_law;
flat out vec3 vs_shown;

void main()
{
    vec2 ndc = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    vs_ray = (ndc + fog_frustum.zw) * fog_frustum.xy;
    vs_place = ndc * 0.5 + 0.5;
    vs_rise = dot(fog_up.xyz, vec3(vs_ray, -1.0)) * fog_up.w;
    vs_law = fog_law.xyz;
    vs_shown = fog_shown.rgb;
    gl_Position = vec4(ndc, 0.0, 1.0);
}
