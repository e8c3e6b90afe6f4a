// The m2 of a gauge's catch that the container's drops tell of (the first points of an instance), and
// the share of its own opening that rain reaches (the others).
#include "gauge.glsl"

flat out vec4 vs_sum;

const int CATCH = 128;  // points; also in gpu/gauge_pass.py
const int OWN = 32;

void main()
{
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    vs_sum = vec4(0.0);
    vec4 gauge = gauge_place[gl_InstanceID];
    bool own = gl_VertexID >= CATCH;
    int k = own ? gl_VertexID - CATCH : gl_VertexID;
    float share = (float(k) + 0.5) / float(own ? OWN : CATCH);
    vec4 wide = gauge_catch[gl_InstanceID];
    float radius = own ? gauge.w : wide.z;
    float angle = gauge_turn + 2.3999632 * float(k);
    vec3 p = own ? gauge.xyz : vec3(wide.x, gauge.y, wide.y);
    p.xz += radius * sqrt(share) * vec2(cos(angle), sin(angle));
    // The opening is level, the catch as high as the slab.
    if (!own) p.y += GAUGE_SLAB * fract(0.61803399 * float(k) + gauge_turn);
    if (own ? !gauge_open(p) : !gauge_watched(p) || !gauge_clear(p)) return;
    if (own) vs_sum.z = 1.0 / float(OWN);
    else vs_sum.y = 3.14159265 * radius * radius / float(CATCH);
    gl_Position = gauge_texel(gl_InstanceID);
}
