// One step of one drop; physics/rain_step.py is its oracle, symbol for symbol.
//
// A drop keeps to the half disc of its own reach s about the container's centre. The container
// may move, turn and change its size between two steps; what stays inside keeps its place in the
// world. What is left outside comes in again where the half disc has gained as much as it lost:
//   moved by d:  along the line of d, by the length of the chord of that line (each line is a ring)
//   turned:      through the centre (the wedge lost and the wedge gained face each other)
//   risen, sunk: by the height (the vertical is a ring)
// A map of both kinds that ends where the container stood before is applied again, until it ends
// in what is new. These maps keep an even filling even, however far and fast the observer goes, so
// that the law of Eq. 2 holds at every moment and not only for an observer at rest.
//
// A step has two halves: all drops go on, and the few that have left come in again. A compiler for
// vectors works out for every drop what is behind a branch, so the second half is one of its own.
#include "hash.glsl"
#include "drop_law.glsl"
#include "drop_weight.glsl"
#include "landed.glsl"
#include "turbulence.glsl"
#ifdef SNOW
#include "snow_law.glsl"
#endif
#include <block:RainStep>
#ifndef STEADY_AIR
#include "drop_entry.glsl"
#endif
#ifdef SHELTER
#include "shelter.glsl"
#endif

vec2 resettle(uint id, float s)
{
    uint h = hash_word(id ^ hash_word(rain_seed));
    return half_disc_point(s, hash_unit(h), hash_unit(h ^ 0x9E3779B9u));
}

// q outside the half disc of radius s, having moved against it by `moved`: around the ring.
bool ring(inout vec2 q, vec2 moved, float s)
{
    float length_moved = length(moved);
    if (length_moved < 1e-9) return false;
    vec2 e = moved / length_moved;
    float along = dot(q, e);
    float root = s * s - (dot(q, q) - along * along);
    if (root <= 0.0) return false;
    root = sqrt(root);
    float first = -along - root;
    float last = -along + root;
    // The flat back cuts the chord where q.x + t e.x = 0.
    if (abs(e.x) > 1e-7) {
        float back = -q.x / e.x;
        if (e.x > 0.0) first = max(first, back); else last = min(last, back);
    } else if (q.x < 0.0) return false;
    float chord = last - first;
    if (chord <= 1e-7 * s) return false;
    q += e * (chord * floor(-first / chord) * -1.0);
    return true;
}

// The container's move and turn as a map of the half disc before onto the one after.
bool follow(inout vec2 at, vec2 drift, float s)
{
    vec4 axis = vec4(to_axis.xy, from_axis.zw);
    vec2 q = to_container(at, axis, to_shape.xy);
    if (!in_half_disc(q, s)) {
        vec2 moved = turn_to_container(drift - (to_axis.xy - from_axis.xy), axis, to_shape.xy);
        if (!ring(q, moved, s)) return false;
        at = from_container(q, axis, to_shape.xy);
    }
    if (from_axis.zw != to_axis.zw) {
        q = to_container(at, to_axis, to_shape.xy);
        if (!in_half_disc(q, s)) {
            q = -q;
            if (!in_half_disc(q, s)) return false;
            at = from_container(q, to_axis, to_shape.xy);
        }
    }
    return true;
}

// Puts in again a drop that has moved by `drift` and left its container.
void keep_in_container(uint id, float s, vec2 drift, inout vec3 p)
{
    // The container has moved and turned. What is in both places stays; what is left outside is
    // carried on until it comes to where the container has only just arrived.
    if (!in_half_disc(to_container(p.xz, to_axis, to_shape.xy), s)) {
        vec2 at = p.xz;
        bool arrived = false;
        for (int i = 0; i < 4 && !arrived; ++i) {
            if (!follow(at, drift, s)) break;
            arrived = !in_half_disc(to_container(at - drift, from_axis, to_shape.xy), s);
        }
        p.xz = arrived ? at : from_container(resettle(id, s), to_axis, to_shape.xy);
    }
    // The container has risen or sunk; or the drop has reached the bottom, and another begins.
    float turns = floor((p.y - to_shape.z) / to_shape.w);
    p.y -= turns * to_shape.w;
    if (turns < 0.0) p.xz = from_container(resettle(id, s), to_axis, to_shape.xy);
}

#ifdef SHELTER
// Where the way from a to b, places of the map, meets the surface, as a share of it: true for a hit,
// which is exact and not the step's end. A way that crosses an edge of the map far below the surface
// beside it has come in from the side, under an overhang: that is no hit.
bool meets(vec3 a, vec3 b, out float share, out vec3 normal)
{
    float low = 0.0;
    share = 1.0;
    // Twelve times. Not counted, so that compilers do not unroll it for drops that hit nothing.
    while (share - low > 1.0 / 4096.0) {
        float middle = 0.5 * (low + share);
        if (below_surface(mix(a, b, middle)) > 0.0) share = middle;
        else low = middle;
    }
    vec3 m = mix(a, b, share);
    vec2 part;
    vec4 c = shelter_corners(m.xy, part);
    normal = corners_normal(c, part);
    return below_corners(m, c, part) < 0.25;
}

// Where a drop that step_drop has found below the surface has met it on its way from `before` to p:
// v is then the hit, see landed.glsl, and normal that of the surface. False where it met nothing.
bool find_hit(vec3 before, vec3 p, inout vec3 v, out vec3 normal)
{
    vec3 a = shelter_place(before);
    normal = vec3(0.0, 1.0, 0.0);
    if (!in_shelter_map(a) || below_texel(a) > 0.0) return false;
    float share;
    if (!meets(a, shelter_place(p), share, normal)) return false;
    vec3 at = mix(before, p, share);
    v = vec3(at.x, at.y + LANDED, at.z);
    return true;
}
#endif

// In still air, m/s.
vec3 own_velocity(uint id, float quantile)
{
#ifdef SNOW
    return flake_velocity(id, quantile, rain_law);
#else
    return vec3(0.0, -drop_speed(drop_diameter(quantile, rain_law)), 0.0);
#endif
}

// The first half of a step, of all drops: the drop goes on. False where it has left its container or
// begins anew, and is to come in by the second half.
bool carry_drop(uint id, vec4 birth, inout vec3 p, inout vec3 v)
{
    vec3 own = own_velocity(id, birth.w);
    vec3 drift = air_velocity(p) + own;
    bool landed = has_landed(v);
    // Drag brings a drop to the air's own motion with the time constant of its terminal speed.
    vec3 motion = landed ? drift : v;
    motion += (drift - motion) * (1.0 - exp(-rain_dt * 9.8 / max(-own.y, 0.1)));
    p += motion * rain_dt;
    // The size has changed: the container's own axes keep the drop's place.
    if (from_shape.xy != to_shape.xy)
        p.xz = from_container(to_container(p.xz, from_axis, from_shape.xy), from_axis, to_shape.xy);
    if (from_shape.w != to_shape.w)
        p.y = to_shape.z + (p.y - from_shape.z) * (to_shape.w / from_shape.w);
    bool stays = id < rain_fresh && floor((p.y - to_shape.z) / to_shape.w) == 0.0
        && in_half_disc(to_container(p.xz, to_axis, to_shape.xy), birth.z);
    if (!(landed && stays)) v = motion;
    return stays;
}

// The second half, of those few: where the drop is now, if it comes in anywhere alike.
void place_drop(uint id, vec4 birth, vec3 motion, inout vec3 p)
{
    if (id >= rain_fresh) {
        p.xz = from_container(birth.xy, to_axis, to_shape.xy);
        p.y = to_shape.z + to_shape.w * hash_unit(id * 2u + 1u);
    } else keep_in_container(id, birth.z, motion.xz * rain_dt, p);
}

// True where a drop in the air has come below the surface, or come in there. It has landed then, and
// v says so, as for one that came in under cover.
bool land_drop(vec3 p, inout vec3 v)
{
#ifdef SHELTER
    vec3 m = shelter_place(p);
    if (!has_landed(v) && in_shelter_map(m) && below_texel(m) > 0.0) {
        v = vec3(p.x, NO_IMPACT, p.z);
        return true;
    }
#endif
    return false;
}
