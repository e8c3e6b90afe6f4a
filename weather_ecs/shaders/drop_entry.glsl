// Where drops come in in air that does not move alike everywhere; physics/rain_entry.py is its oracle.
// Needs the block RainStep.
#include "hash.glsl"
#include "container.glsl"
#include "turbulence.glsl"

const int ENTRIES = 12;         // places that are tried for a drop that comes in
const float EDDY_REACH = 2.5;   // standard deviations; few eddies are stronger

// A place near the border, evenly in all where a drop may have come in during the step: below the
// top, above the bottom, along the sides. False for one of the sides' that counts twice.
bool border_place(uint h, float s, vec3 own, out vec3 p)
{
    vec2 reach = to_shape.xy;
    float eddy = EDDY_REACH * air_gain.w * rain_dt;
    float fall = -own.y * rain_dt;
    float low = min(max(eddy - fall, 0.0), 0.5 * to_shape.w);
    float high = min(max(fall + eddy, 0.0), 0.5 * to_shape.w);
    float middle = to_shape.w - low - high;
    vec3 fastest = mean_velocity(vec3(0.0, to_shape.z + to_shape.w, 0.0)) + own;
    vec2 moved = fastest.xz * rain_dt - (to_axis.xy - from_axis.xy);
    float side = min((length(moved) + eddy) / min(reach.x, reach.y), s);
    float level = 1.57079633 * s * s * (low + high);
    float rim = 1.57079633 * side * (2.0 * s - side) * middle;
    float back = 2.0 * s * side * middle;
    float u = hash_unit(h);
    float v = hash_unit(h ^ 0x9E3779B9u);
    float w = hash_unit(h ^ 0x85EBCA6Bu);
    float pick = hash_unit(h ^ 0xC2B2AE35u) * (level + rim + back);
    float y = low + middle * w;
    vec2 q = half_disc_point(s, u, v);
    bool once = true;
    if (pick < level) {
        y = w * (low + high);
        if (y >= low) y += middle;
    } else if (pick < level + rim) {
        q = half_disc_point(1.0, 1.0, v) * sqrt(mix((s - side) * (s - side), s * s, u));
    } else {
        q = vec2(side * u, s * (2.0 * v - 1.0));
        once = length(q) < s - side;
    }
    p.xz = from_container(q, to_axis, reach);
    p.y = to_shape.z + y;
    return once;
}

// Where the air moves otherwise from place to place, it brings in more drops at some places of the
// border than at others. Drops that came in anywhere alike would gather where they come in slowly and
// be missing elsewhere, so one that has left comes in again evenly in what is new: where the motion
// there has just brought in what was outside before. Its velocity; p is moved there.
vec3 come_in(uint id, float s, vec3 own, bool sought, inout vec3 p)
{
    vec3 other = p;
    vec3 v;
    uint h = id ^ hash_word(rain_seed);
    for (int left = sought ? ENTRIES : 0; ; --left) {
        bool found = left == 0;
        if (found) p = other;
        else {
            h = hash_word(h);
            found = border_place(h, s, own, p);
        }
        // It lags behind the air, and has the motion of where it was a moment ago.
        vec3 felt = p + vec3(0.0, own.y * own.y / 9.8, 0.0);
        v = mean_velocity(felt) + own;
        if (air_gain.w > 0.0) v += eddies_felt(felt, -own.y);
        vec3 before = p - v * rain_dt;
        float rise = before.y - from_shape.z;
        bool was_in = rise >= 0.0 && rise < from_shape.w
            && in_half_disc(to_container(before.xz, from_axis, to_shape.xy), s);
        if (left == 0 || (found && !was_in)) break;
    }
    return v;
}
