// Moves the drops of one container, in place, and lists what they hit: the single kernel of the
// compute backend.
layout(local_size_x = 128) in;
#include "drop_step.glsl"
#ifdef SHELTER
#include "impact_list.glsl"
#endif

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };
layout(std430, binding = 1) buffer Drops { float drops[]; };  // position, velocity: 6 floats

void main()
{
    uint id = gl_GlobalInvocationID.x;
    if (id >= rain_count) return;
    uint k = id * 6u;
    vec4 birth = births[id];
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    vec3 v = vec3(drops[k + 3u], drops[k + 4u], drops[k + 5u]);
    vec3 normal;
    bool hits = step_drop(id, birth, p, v, normal);
    drops[k] = p.x;
    drops[k + 1u] = p.y;
    drops[k + 2u] = p.z;
    drops[k + 3u] = v.x;
    drops[k + 4u] = v.y;
    drops[k + 5u] = v.z;
#ifdef SHELTER
    if (hits) {
        vec3 at = vec3(v.x, v.y - LANDED, v.z);
        float d;
        float weight = drop_weight(at, birth.z, int(id), d);
        float diameter = drop_diameter(birth.w, rain_law);
        float speed = drop_speed(diameter);
        float age = max(at.y - p.y, 0.0) / max(speed, 0.1);
        if (weight > 0.0)
            append_impact(at, rain_time - age, normal, diameter, speed, weight, birth.w);
    }
#endif
}
