// The collision heightmap: what rain meets first along its mean fall direction. shelter_matrix takes
// world points to (u, v, depth), all in [0, 1] where the map knows; shelter_size is the map's side
// in texels, its height span in m, a texel in m, and the slope of the fall is (shelter_fall).
#include <block:Shelter>

uniform sampler2D shelter_map;

// A step in depth of more than this (m) between neighbours is an edge and not a slope; and so is one
// of more than so many texels, but for small ones, lest rain hit a slope from a hat to shoulders.
const float SHELTER_EDGE = 0.6;
const float SHELTER_STEEP = 2.0;
const float SHELTER_STEP = 0.2;  // m

vec3 shelter_place(vec3 p)
{
    return (shelter_matrix * vec4(p, 1.0)).xyz;
}

bool in_shelter_map(vec3 m)
{
    return all(greaterThan(m, vec3(0.0, 0.0, -1e3))) && all(lessThan(m.xy, vec2(1.0)));
}

// Metres by which a place of the map lies below the surface; negative above it.
float below_texel(vec3 m)
{
    ivec2 at = ivec2(m.xy * shelter_size.x);
    return (m.z - texelFetch(shelter_map, at, 0).r) * shelter_size.y;
}

// Depths of the four texels around a place, and the place between them; x: lower left, y: lower
// right, z: upper left, w: upper right.
vec4 shelter_corners(vec2 uv, out vec2 part)
{
    vec2 at = uv * shelter_size.x - 0.5;
    vec2 low = floor(at);
    part = at - low;
    ivec2 last = ivec2(int(shelter_size.x) - 1);
    ivec2 a = clamp(ivec2(low), ivec2(0), last);
    ivec2 b = clamp(ivec2(low) + 1, ivec2(0), last);
    return vec4(texelFetch(shelter_map, a, 0).r, texelFetch(shelter_map, ivec2(b.x, a.y), 0).r,
                texelFetch(shelter_map, ivec2(a.x, b.y), 0).r, texelFetch(shelter_map, b, 0).r);
}

bool is_edge(vec4 c)
{
    float low = min(min(c.x, c.y), min(c.z, c.w));
    float high = max(max(c.x, c.y), max(c.z, c.w));
    float edge = clamp(SHELTER_STEEP * shelter_size.z, SHELTER_STEP, SHELTER_EDGE);
    return (high - low) * shelter_size.y > edge;
}

// Metres by which a place lies below the surface between four texels, as below_texel where they are
// an edge.
float below_corners(vec3 m, vec4 c, vec2 part)
{
    vec2 row = part.y < 0.5 ? c.xy : c.zw;
    float depth = is_edge(c) ? (part.x < 0.5 ? row.x : row.y)
                             : mix(mix(c.x, c.y, part.x), mix(c.z, c.w, part.x), part.y);
    return (m.z - depth) * shelter_size.y;
}

// As below_texel, against the surface that slopes between the texels.
float below_surface(vec3 m)
{
    vec2 part;
    vec4 c = shelter_corners(m.xy, part);
    return below_corners(m, c, part);
}

// Upward normal of the surface between four texels; straight up at an edge.
vec3 corners_normal(vec4 c, vec2 part)
{
    if (is_edge(c)) return vec3(0.0, 1.0, 0.0);
    // Rise along x and z of the map, m per m; the map is sheared by the fall, the world is not.
    vec2 rise = vec2(mix(c.x - c.y, c.z - c.w, part.y), mix(c.x - c.z, c.y - c.w, part.x))
        * (shelter_size.y / shelter_size.z);
    vec2 slope = rise / max(1.0 - dot(rise, shelter_fall.xy), 0.2);
    return normalize(vec3(-slope.x, 1.0, -slope.y));
}

// The same at a place of the map.
vec3 surface_normal(vec2 uv)
{
    vec2 part;
    vec4 c = shelter_corners(uv, part);
    return corners_normal(c, part);
}
