// One triangle over the whole target; its rays, 1 long along the camera's forward axis.
#include <block:FogView>

// To the right, upwards in the picture, upwards in the world: all linear over the picture.
noperspective out vec3 vs_ray;

void main()
{
    vec2 ndc = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    vec2 slope = (ndc + fog_frustum.zw) * fog_frustum.xy;
    vs_ray = vec3(slope, dot(fog_up.xyz, vec3(slope, -1.0)));
    gl_Position = vec4(ndc, 0.0, 1.0);
}
