// The list of impacts that the compute backend keeps: a ring, bounded in every frame. What comes when
// a frame's room is used up is counted and not written.
#include "impact_counts.glsl"

layout(std430, binding = 3) writeonly buffer Impacts { vec4 impacts[]; };  // three a record

void append_impact(vec3 at, float time, vec3 normal, float diameter, float speed, float weight,
                   float seed, float ride)
{
    uint k = atomicAdd(impact_total, 1u);
    if (k - total_before >= impact_capacity) {
        // Taken back; meanwhile no other can find room either.
        atomicAdd(impact_total, 0xFFFFFFFFu);
        atomicAdd(impact_dropped, 1u);
        return;
    }
    k = (k % impact_capacity) * 3u;
    impacts[k] = vec4(at, time);
    impacts[k + 1u] = vec4(normal, diameter);
    impacts[k + 2u] = vec4(speed, weight, seed, ride);
}
