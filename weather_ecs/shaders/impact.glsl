// What rain has hit, one vertex an impact, the same from both backends:
//   IMPACT_LIST   the records that the compute kernel has listed
//   otherwise     the drops themselves, each with its own last impact (feedback)
// read_impact gives false where a vertex holds none. The program needs the block RainView; without
// IMPACT_LIST also the block RainDraw of the container and the collision heightmap. A compute shader
// has the records of the list by their numbers.
#include <block:RainView>

struct Impact {
    vec3 position;   // m, on the surface
    float age;       // s, of the weather's clock
    vec3 normal;     // of the surface, upward
    float diameter;  // mm
    float speed;     // m/s
    float weight;    // real drops that it stands for
    float seed;      // in [0, 1)
    vec3 ride;       // m/s, of what was hit
};

#include "motion.glsl"

#if defined(IMPACT_LIST) || defined(IMPACT_RECORDS)
bool unpack_impact(vec4 hit, vec4 surface, vec4 fall, out Impact i)
{
    i = Impact(hit.xyz, view_time.x - hit.w, surface.xyz, surface.w, fall.x, fall.y, fall.z,
               motion_velocity(unpacked_motion(fall.w)));
    return i.age >= 0.0 && i.age < 100.0;
}
#endif
#ifdef IMPACT_RECORDS
layout(std430, binding = 3) readonly buffer Impacts { vec4 impacts[]; };  // three a record

bool read_impact(uint record, out Impact i)
{
    uint k = record * 3u;
    return unpack_impact(impacts[k], impacts[k + 1u], impacts[k + 2u], i);
}
#elif defined(IMPACT_LIST)
in vec4 in_hit;
in vec4 in_surface;
in vec4 in_fall;

bool read_impact(out Impact i)
{
    return unpack_impact(in_hit, in_surface, in_fall, i);
}
#else
#include "drop_law.glsl"
#include "drop_weight.glsl"
#include "landed.glsl"
#include "shelter_motion.glsl"

in vec3 in_position;
in vec3 in_velocity;
in vec4 in_birth;

bool read_impact(out Impact i)
{
    i = Impact(vec3(0.0), 1e9, vec3(0.0, 1.0, 0.0), 0.0, 0.0, 0.0, in_birth.w, vec3(0.0));
    if (!has_landed(in_velocity) || in_velocity.y > 1e8) return false;
    i.position = vec3(in_velocity.x, in_velocity.y - LANDED, in_velocity.z);
    i.diameter = drop_diameter(in_birth.w, drop_law);
    i.speed = drop_speed(i.diameter);
    // The place-holder has fallen on at the drop's own speed ever since.
    i.age = max(i.position.y - in_position.y, 0.0) / max(i.speed, 0.1);
    float d;
    i.weight = drop_weight(i.position, in_birth.z, gl_VertexID, d);
    i.weight *= drop_arrived(i.position.y, i.speed, i.age);
    vec3 at = shelter_place(i.position);
    i.normal = surface_normal(at.xy);
    // Of what is there by now, most often the same; and it was hit in the course of a step.
    i.ride = met_velocity(at);
    i.position -= i.ride * min(i.age, view_time.y);
    return i.weight > 0.0;
}
#endif
