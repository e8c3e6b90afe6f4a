// How many real drops one drawn drop stands for; see physics/lod.py. d: its distance from the
// container's centre as a share of the reach.
#include "container.glsl"
#include "rain_area.glsl"
#include "rain_front.glsl"
#include <block:RainDraw>

// Where the area's rain is full.
float drop_load_at(vec3 p, float own_reach, int id, out float d)
{
    vec2 q = to_container(p.xz, container_axis, container_shape.xy);
    d = min(length(q), 0.999);
    float rim = clamp((1.0 - d / own_reach) * 4.0, 0.0, 1.0);
    float last = clamp((drop_load.y - float(id)) * drop_load.z, 0.0, 1.0);
    float shape = d < 0.75 ? 0.875 - d : 2.0 * (1.0 - d) * (1.0 - d);
    return drop_load.x * d / shape * rim * last;
}

// 1 where a drop at the height y is there, which falls at `speed` and has been at y some s ago; 0 where
// it was not raining when it should have left the ceiling.
float drop_arrived(float y, float speed, float ago)
{
    if (drop_dry == SETTLED) return 1.0;
    return fallen_share((area_shape.w - y) / max(speed, 0.1) + ago, drop_dry);
}

float drop_weight(vec3 p, float own_reach, int id, out float d)
{
    return drop_load_at(p, own_reach, id, d) * area_factor(p.xz, area_axis, area_shape);
}
