// Finds what the drops have hit that rain_step.comp has listed, and lists the impacts.
layout(local_size_x = 64) in;  // FIND_GROUP
#define SHELTER
#include "drop_step.glsl"
#include "impact_list.glsl"
#include "shelter_motion.glsl"

layout(std430, binding = 0) readonly buffer Births { vec4 births[]; };
layout(std430, binding = 1) buffer Drops { float drops[]; };
layout(std430, binding = 4) readonly buffer Sunk { uvec4 sunk[]; };

void main()
{
    uint at = gl_GlobalInvocationID.x;
    if (at >= min(sunk_count, uint(sunk.length()))) return;
    uvec4 found = sunk[at];
    uint id = found.w;
    uint k = id * 6u;
    vec3 p = vec3(drops[k], drops[k + 1u], drops[k + 2u]);
    vec3 v;
    vec3 normal;
    if (!find_hit(uintBitsToFloat(found.xyz), p, v, normal)) return;
    drops[k + 3u] = v.x;
    drops[k + 4u] = v.y;
    drops[k + 5u] = v.z;
    vec3 hit = vec3(v.x, v.y - LANDED, v.z);
    vec4 birth = births[id];
    float diameter = drop_diameter(birth.w, rain_law);
    float speed = drop_speed(diameter);
    float age = max(hit.y - p.y, 0.0) / max(speed, 0.1);
    float d;
    float weight = drop_weight(hit, birth.z, int(id), d) * drop_arrived(hit.y, speed, age);
    if (weight <= 0.0) return;
    // What was hit is there now; where it was when it was hit, so that the splash rides on with it.
    vec3 bytes = met_motion(shelter_place(hit));
    hit -= motion_velocity(bytes) * age;
    append_impact(hit, rain_time - age, normal, diameter, speed, weight, birth.w,
                  packed_motion(bytes));
}
