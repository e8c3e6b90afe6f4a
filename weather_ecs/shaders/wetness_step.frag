// One texel of the wetness map: water and snow on what rain meets first there, and its height.
// physics/wet_map.py is its oracle. The map lies like the collision heightmap, every texel over two
// by two of its own, of whose surfaces it takes the lowest: thin rails do not hide the ground below
// them, they keep a share of the rain off it. What is slender and far above it, a lamp or a pole, does
// neither: drops of all sizes and gusts slant in below it. What lay at the same place of the world in
// the map before is carried on.
#include "wetness_law.glsl"
#include "snow_cover.glsl"
#include "rain_area.glsl"
#include "rain_front.glsl"
#include "shelter.glsl"  // shelter_map is the layer of what does not move
#include <block:WetStep>

uniform sampler2D wet_cover;   // depth of all that rain can hit, what moves included
uniform sampler2D wet_before;  // mm, m, mm
uniform sampler2D wet_far;     // mm of both on level ground in the open, from the CPU

out vec4 water;  // mm; m, height of the surface, NOTHING where there is none; mm of snow

const float NOTHING = -1e9;
const float SAME = 0.5;     // m between heights of what may be one surface
const float COVERED = 0.1;  // m by which a moving thing stands over it
const float SLENDER = 0.8;  // m, width of what hides nothing
const float FAR_ABOVE = 1.0;  // m over what is beside it

vec2 open_water(vec2 p)
{
    return texture(wet_far, (p - wet_far_place.xy) * wet_far_place.z + 0.5).rg;
}

// Height in m of the surface at a texel of the heightmap; NOTHING where there is none.
float height_at(ivec2 at)
{
    at = clamp(at, ivec2(0), ivec2(int(shelter_size.x) - 1));
    float depth = texelFetch(shelter_map, at, 0).r;
    return depth < 1.0 ? wet_heights.x - depth * shelter_size.y : NOTHING;
}

// The same of all that rain can hit, what moves included.
float cover_at(ivec2 at)
{
    at = clamp(at, ivec2(0), ivec2(int(shelter_size.x) - 1));
    return wet_heights.x - texelFetch(wet_cover, at, 0).r * shelter_size.y;
}

// The higher of two heights on either side of a texel's two by two.
float beside_of(ivec2 at, ivec2 off)
{
    return max(height_at(at + off), height_at(at + 1 - off));
}

// A neighbour's height; the surface's own where that is another surface.
float near_height(ivec2 at, float y)
{
    float h = height_at(at);
    return abs(h - y) < SHELTER_EDGE ? h : y;
}

// mm by which the surface lies below the mean of a ring of `step` texels around it.
float hollow(ivec2 at, int step, float y)
{
    int d = max(int(0.7071 * float(step) + 0.5), 1);
    float sum = near_height(at + ivec2(step, 0), y) + near_height(at - ivec2(step, 0), y)
        + near_height(at + ivec2(0, step), y) + near_height(at - ivec2(0, step), y)
        + near_height(at + ivec2(d, d), y) + near_height(at - ivec2(d, d), y)
        + near_height(at + ivec2(d, -d), y) + near_height(at - ivec2(d, -d), y);
    return clamp((sum * 0.125 - y) * 1000.0, 0.0, DEEPEST);
}

void main()
{
    vec2 texel = floor(gl_FragCoord.xy);
    vec2 place = wet_frame.xy + (texel + 0.5 - 0.5 * wet_frame.w) * wet_frame.z;
    ivec2 at = ivec2(floor((place - wet_shelter.xy) * wet_shelter.z - 0.5));
    vec4 heights = vec4(height_at(at), height_at(at + ivec2(1, 0)), height_at(at + ivec2(0, 1)),
                        height_at(at + ivec2(1)));
    vec4 known = step(-1e8, heights);
    vec4 found = mix(vec4(1e9), heights, known);
    float y = min(min(found.x, found.y), min(found.z, found.w));
    water = vec4(0.0, NOTHING, 0.0, 0.0);
    if (y > 1e8) return;
    int wide = max(int(floor(0.5 * (SLENDER / shelter_size.z - 1.0) + 0.5)), 1);
    float beside = min(min(beside_of(at, ivec2(-wide, 0)), beside_of(at, ivec2(1, -wide))),
                       min(beside_of(at, ivec2(-wide)), beside_of(at, ivec2(1 + wide, -wide))));
    float top = max(max(heights.x, heights.y), max(heights.z, heights.w));
    bool slender = beside > NOTHING && beside < top - FAR_ABOVE;
    if (slender && beside < y - FAR_ABOVE) y = beside;
    water.g = y;
    vec3 p = vec3(place.x - y * shelter_fall.x, y, place.y - y * shelter_fall.y);

    // What lay here before.
    vec2 w = open_water(p.xz);
    float seconds = 0.0;
    bool fresh = true;
    vec2 old = (p.xz + y * wet_old_fall.xy - wet_old_frame.xy) / wet_old_frame.z;
    ivec2 from = ivec2(floor(old + 0.5 * wet_old_frame.w));
    ivec2 last = ivec2(int(wet_old_frame.w) - 1);
    if (all(greaterThanEqual(from, ivec2(0))) && all(lessThanEqual(from, last))) {
        vec3 was = texelFetch(wet_before, from, 0).rgb;
        if (abs(was.g - y) < SAME) {
            w = was.rb;
            fresh = false;
            int band = from.y / int(wet_bands);
            seconds = wet_ages[band / 4][band % 4];
        } else if (was.g > y) w = vec2(0.0);  // it was under cover
    }

    // Rain that reaches it since, on the slope's own square metre.
    float rate = 0.0;
    for (int i = 0; i < wet_areas; ++i)
        if (y < wet_area_shape[i].w) {
            float here = area_factor(p.xz, wet_area_axis[i], wet_area_shape[i]);
            if (here > 0.0 && wet_area_dry[i] != SETTLED)
                here *= water_arrived(wet_area_shape[i].w - y, wet_area_dry[i], wet_area_rate[i].y);
            rate += wet_area_rate[i].x * here;
        }
    vec4 tops = vec4(cover_at(at), cover_at(at + ivec2(1, 0)), cover_at(at + ivec2(0, 1)),
                     cover_at(at + ivec2(1)));
    vec4 open = step(slender ? vec4(0.0) : heights - y, vec4(SAME)) * step(tops - y, max(heights - y, 0.0) + COVERED);
    rate *= dot(known, open) / dot(known, vec4(1.0));
    vec2 rise = vec2(near_height(at + ivec2(2, 0), y) + near_height(at + ivec2(2, 1), y)
                         - near_height(at + ivec2(-1, 0), y) - near_height(at + ivec2(-1, 1), y),
                     near_height(at + ivec2(0, 2), y) + near_height(at + ivec2(1, 2), y)
                         - near_height(at + ivec2(0, -1), y) - near_height(at + ivec2(1, -1), y))
        / (6.0 * shelter_size.z);
    vec2 slope = rise / max(1.0 - dot(rise, shelter_fall.xy), 0.2);
    float up = inversesqrt(1.0 + dot(slope, slope));
    float facing = max(1.0 + dot(slope, shelter_fall.xy), 0.0) * up;
    float own = near_height(at, y);  // the rings lie about this one of the four
    float deep = max(hollow(at, wet_rings.x, own), hollow(at, wet_rings.y, own));
    float gathers = 1.0 + CATCHMENT * smoothstep(1.0, 20.0, deep);
    // What melts wets the ground below; what is new on the map has the open field's snow.
    float stays = snow_stays(up);
    if (fresh) w.y *= stays;
    float falls = rate / 3600.0 * facing;
    water.b = collect(w.y, falls * wet_snow.z * stays, wet_snow.y, seconds);
    float melted = 0.0;
    if (seconds > 0.0) melted = (w.y + falls * wet_snow.z * stays * seconds - water.b) / seconds;
    float inflow = falls * (1.0 - wet_snow.x) * gathers + max(melted, 0.0);
    water.r = settle(w.x, inflow, film_capacity(up) + deep, seconds);
}
