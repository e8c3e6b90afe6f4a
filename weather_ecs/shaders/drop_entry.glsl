// Where drops come in in air that does not move alike everywhere; physics/rain_entry.py is its oracle.
// Needs the block RainStep.
#include "hash.glsl"
#include "container.glsl"
#include "turbulence.glsl"

const int ENTRIES = 12;         // places that are tried for a drop that comes in
const float EDDY_REACH = 2.5;   // standard deviations; few eddies are stronger

// A place near the border, evenly in all where a drop may have come in during the step: below the
// top, above the bottom, along the sides. False for one of the sides' that counts twice.
bool border_place(uint word, float s, vec3 own, vec3 felt, out vec3 p)
{
    vec2 reach = to_shape.xy;
    float eddy = EDDY_REACH * length(air_gain.xyz * felt) * rain_dt;
    float fall = -own.y * rain_dt;
    float low = clamp(eddy - fall, 0.0, 0.5 * to_shape.w);
    float high = clamp(fall + eddy, 0.0, 0.5 * to_shape.w);
    float middle = to_shape.w - low - high;
    vec3 fastest = mean_velocity(vec3(0.0, to_shape.z + to_shape.w, 0.0)) + own;
    vec2 moved = fastest.xz * rain_dt - (to_axis.xy - from_axis.xy);
    float side = min((length(moved) + eddy) / min(reach.x, reach.y), s);
    float level = 1.57079633 * s * s * (low + high);
    float rim = 1.57079633 * side * (2.0 * s - side) * middle;
    float back = 2.0 * s * side * middle;

    // Four numbers in [0, 1) of 16 bits.
    uint other = hash_word(word ^ 0x9E3779B9u);
    vec4 u = vec4(word >> 16u, word & 0xFFFFu, other >> 16u, other & 0xFFFFu) * (1.0 / 65536.0);
    float pick = u.w * (level + rim + back);
    bool on_level = pick < level;
    bool on_back = pick >= level + rim;
    float y = u.z * (on_level ? low + high : middle);
    if (!on_level || y >= low) y += on_level ? middle : low;
    float inner = on_level ? 0.0 : s - side;
    vec2 q = half_disc_point(1.0, 1.0, u.y) * sqrt(mix(inner * inner, s * s, u.x));
    if (on_back) q = vec2(side * u.x, s * (2.0 * u.y - 1.0));
    p.xz = from_container(q, to_axis, reach);
    p.y = to_shape.z + y;
    return !on_back || length(q) < inner;
}

// Where the air moves otherwise from place to place, it brings in more drops at some places of the
// border than at others. Drops that came in anywhere alike would gather where they come in slowly and
// be missing elsewhere, so one that has left comes in again evenly in what is new: where the motion
// there has just brought in what was outside before. That is tried place by place: `word` and `left`
// are begin_entry's; true once it is found, p being the place and v the velocity there.
void begin_entry(uint id, out uint word, out int left)
{
    // A container that turns or grows has other places that are new; there is a map for these.
    bool sought = id < rain_fresh && air_gain.w > 0.0
        && from_axis.zw == to_axis.zw && from_shape == to_shape;
    word = id ^ hash_word(rain_seed);
    left = sought ? ENTRIES : 0;
}

bool try_entry(inout uint word, inout int left, float s, vec3 own, inout vec3 p, out vec3 v)
{
    bool last = left-- == 0;
    word = hash_word(word);
    vec3 at;
    vec3 felt = felt_shares(-own.y);
    bool found = border_place(word, s, own, felt, at);
    if (last) at = p;
    // It lags behind the air, and has the motion of where it was a moment ago.
    vec3 behind = at + vec3(0.0, own.y * own.y / 9.8, 0.0);
    v = mean_velocity(behind) + own;
    if (air_gain.w > 0.0) v += eddies_felt(behind, felt);
    vec3 before = at - v * rain_dt;
    float rise = before.y - from_shape.z;
    bool was_in = rise >= 0.0 && rise < from_shape.w
        && in_half_disc(to_container(before.xz, from_axis, to_shape.xy), s);
    found = last || (found && !was_in);
    if (found) p = at;
    return found;
}
