// A rectangle of the picture, and the view rays through it; no vertex data.
#include <block:Veil>

// Linear in the picture: 1 long along the camera's forward axis, world axes.
noperspective out vec3 vs_ray;
noperspective out vec2 vs_place;  // in the picture, 0 to 1

void main()
{
    vec2 at = mix(veil_frame.xy, veil_frame.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    vs_ray = veil_rays[0].xyz + at.x * veil_rays[1].xyz + at.y * veil_rays[2].xyz;
    vs_place = at * 0.5 + 0.5;
    // At the depth of a scene's empty pixels, so that a depth test can tell them from the others.
    gl_Position = vec4(at, 1.0, 1.0);
}
