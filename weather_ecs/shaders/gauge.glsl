// Rain gauges: what a container's drops say of the rain through their planes. Needs the block RainDraw
// of the container.
#include "container.glsl"
#include <block:RainDraw>
#include <block:Gauge>
#ifdef SHELTER
#include "shelter.glsl"
#endif

// m; drops are counted within this height above the plane.
const float GAUGE_SLAB = 0.5;

// The texel of one gauge and one container, in clip space.
vec4 gauge_texel(int gauge)
{
    return vec4((vec2(gauge, gauge_row) + 0.5) * gauge_scale - 1.0, 0.0, 1.0);
}

// Whether rain reaches a place.
bool gauge_open(vec3 p)
{
#ifdef SHELTER
    vec3 m = shelter_place(p);
    return !in_shelter_map(m) || below_surface(m) < 0.05;
#else
    return true;
#endif
}

// Whether drops of every size reach a place past whatever is near: in wind small ones
// slant in more than the mean fall, and behind a roof fewer of them land than of the large ones.
bool gauge_clear(vec3 p)
{
    if (!gauge_open(p)) return false;
#ifdef SHELTER
    const vec3 SLANTS = vec3(0.65, 1.7, 3.0);  // of the largest, the small and the smallest
    if (dot(shelter_fall.xy, shelter_fall.xy) < 1e-4) return true;
    for (int s = 0; s < 3; ++s) {
        vec3 up = vec3(-shelter_fall.x, 1.0, -shelter_fall.y) * vec3(SLANTS[s], 1.0, SLANTS[s]);
        float high = 0.6;
        for (int k = 0; k < 14; ++k) {
            vec3 m = shelter_place(p + up * high);
            if (!in_shelter_map(m)) break;
            if (below_texel(m) > 0.05) return false;
            high *= 1.25;
        }
    }
#endif
    return true;
}

// Whether the container's drops tell of a place: not at its rim, where few of them stand for many.
bool gauge_watched(vec3 p)
{
    vec2 q = to_container(p.xz, container_axis, container_shape.xy);
    float rise = p.y - container_shape.z;
    return q.x > 0.0 && length(q) < 0.8 && rise > 0.0 && rise < container_shape.w;
}
