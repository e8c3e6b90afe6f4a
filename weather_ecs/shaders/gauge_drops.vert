// One drop over one gauge (an instance): the water it carries downwards, as mm/h over the catch's m2.
// A drop counts while it is within a slab above the plane, for its speed over the slab's height; so a
// crossing is spread over some frames, and what an eddy lifts again is taken off.
// Once with the water that drops carry on average, once with its own (for tests).
#include "drop_law.glsl"
#include "drop_weight.glsl"
#include "landed.glsl"
#include "gauge.glsl"

in vec3 in_position;
in vec3 in_velocity;
in vec4 in_birth;

flat out vec4 vs_sum;

void main()
{
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    vs_sum = vec4(0.0);
    vec4 gauge = gauge_place[gl_InstanceID];
    vec3 v = in_velocity;
    float rise = in_position.y - gauge.y;
    if (has_landed(v) || rise < 0.0 || rise >= GAUGE_SLAB) return;
    vec4 wide = gauge_catch[gl_InstanceID];
    vec2 away = in_position.xz - wide.xy;
    if (dot(away, away) > wide.z * wide.z) return;
    if (!gauge_watched(in_position) || !gauge_clear(in_position)) return;
    float d;
    float weight = drop_load_at(in_position, in_birth.z, gl_VertexID, d);
    float diameter = drop_diameter(in_birth.w, drop_law);
    weight *= drop_arrived(in_position.y, drop_speed(diameter), 0.0);
    vec4 at_gauge = gauge_share[gl_InstanceID];
    float number = weight * -v.y / GAUGE_SLAB * at_gauge.x;  // real drops a second
    float own = 0.5235988 * diameter * diameter * diameter;  // mm3
    vs_sum = vec4(number * gauge_water * at_gauge.y * 3600e-6, 0.0, 0.0, number * own * 3600e-6);
    gl_Position = gauge_texel(gl_InstanceID);
}
