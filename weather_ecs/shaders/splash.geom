// A splash: the film that spreads flat over the surface, the crown on it, and droplets on parabolas
// that end where they hit again; and smaller splashes around it on whatever is there, for the other
// drops that its drop stands for. All but the crown are only there close by. SMALL: there is nothing
// but the crown, and that is so small that one triangle, of twice its area, is drawn sooner than two.
// Where what was hit has gone from under a splash there is none.
layout(points) in;
#ifdef SMALL
layout(triangle_strip, max_vertices = 3) out;
#else
layout(triangle_strip, max_vertices = 71) out;
#endif
#include "splash.glsl"
#include "splash_quad.glsl"
#include "shelter_motion.glsl"
#include "turbulence.glsl"

in vec3 vs_throw[];
in float vs_more[];
in vec3 vs_ridden[];

vec3 hit;  // m, on the surface

const float EDGE = 0.08;  // m, of a drop in height that a droplet may fall over
const float WITHIN = 0.3;  // m, of a droplet below what rain meets first at its place
const float GONE = 0.12;  // m, that a surface may have sunk under a splash; at twice that it is gone
// m: beside what is so much higher it cannot be told whether a hit is before a wall or within it.
const float BESIDE = 0.9;
// What rides on a thing is brought onto it along the fall, by so many m and so much of its way: by
// more, and the map only has not seen something slim.
const float SNAP = 0.05;
const float SNAP_SHARE = 0.2;
const float STEEP = 0.5;  // rise of the normal below which what is hit is a wall

// Whether one of the texels around a place at a depth of the map is of something far above it: there
// a splash would show through the wall.
bool beside_wall(float depth, vec4 c)
{
    return (depth - min(min(c.x, c.y), min(c.z, c.w))) * shelter_size.y > BESIDE;
}

void film(vec3 at, vec3 n, vec4 form, vec4 color)
{
    bool wet = form.z > 0.5;
    float pixels = form.x * camera_position.w / length(at - camera_position.xyz);
    float above = dot(normalize(camera_position.xyz - at), n);
    if (above <= 0.0) return;
    if (form.y >= (wet ? CROWN_LIFE : FILM_LIFE) || pixels < 3.0) return;
    color.a *= smoothstep(3.0, 6.0, pixels);
    vec3 first = normalize(vec3(n.y, -n.x, 0.0));
    vec3 second = cross(n, first);
    float turn = 40.0 * form.w;
    float reach = form.x * growth(form.y) * (wet ? 2.4 : 1.7);
    vec3 a = (first * cos(turn) + second * sin(turn)) * reach;
    vec3 b = (second * cos(turn) - first * sin(turn)) * reach;
    // The more so, the less there is to see of the crown.
    color.a *= 0.35 + 0.4 * smoothstep(0.5, 0.9, above);
    quad(at, a, b, layer_at(wet ? RING : FILM, form.y), color);
}

// A droplet as a streak of its way during the exposure.
void droplet(vec3 p, vec3 velocity, float size, vec4 color)
{
    vec4 b = lifted(p);
    vec4 a = lifted(p - velocity * camera_velocity.w * 0.35);
    if (min(a.w, b.w) < 0.2) return;
    vec2 along = (b.xy / b.w - a.xy / a.w) * view_size.xy;
    float span = length(along);
    along = span > 1e-3 ? along / span : vec2(0.0, 1.0);
    float pixels = size * camera_position.w / b.w;
    color.a *= min(pixels / 1.5, 1.0);
    float wide = max(pixels, 1.5);
    vec2 across = vec2(-along.y, along.x) * wide / view_size.xy;
    vec2 longer = along * wide / view_size.xy;
    // One triangle around the bead, which fills the middle of its picture.
    vec2 start = a.xy / a.w - longer;
    vec2 beyond = b.xy / b.w + longer;
    beyond += beyond - start;
    corner(vec4((start - across) * b.w, b.zw), vec2(0.25, 0.25), BEAD, color);
    corner(vec4((start + 3.0 * across) * b.w, b.zw), vec2(1.25, 0.25), BEAD, color);
    corner(vec4((beyond - across) * b.w, b.zw), vec2(0.25, 1.25), BEAD, color);
    EndPrimitive();
}

// A quad that stands along the normal n and turns about it towards the camera.
void crown(vec3 at, vec3 n, vec4 form, vec4 color)
{
    vec3 up = n;
    vec3 ray = at - camera_position.xyz;
    vec3 side = cross(ray, up);
    float across = length(side);
    if (across < 1e-4 || color.a < FAINTEST) return;
    uint h = hash_word(floatBitsToUint(form.w));
    float variant = float(h & 1u);
    // No two alike: mirrored or not, leaning a little, taller or lower.
    up = normalize(up + side / across * (0.35 * hash_unit(h) - 0.175));
    side = cross(ray, up);
    side *= ((h & 2u) != 0u ? 1.0 : -1.0) / length(side);
    float pixel = length(ray) / camera_position.w;
    float reach = max(form.x * growth(form.y) * 1.33, pixel);
    float tall = reach * (0.8 + 0.5 * hash_unit(h ^ 0x9E3779B9u));
    vec3 middle = at + up * (tall * (TALL - BELOW * lift));
    float kind = (form.z > 0.5 ? BURST : CROWN) + variant;
#ifdef SMALL
    triangle(middle, side * reach, up * (tall * TALL), layer_at(kind, form.y), color);
#else
    quad(middle, side * reach, up * (tall * TALL), layer_at(kind, form.y), color);
#endif
}

void droplets(float seed, vec3 n, vec4 color)
{
    vec3 first = normalize(vec3(n.y, -n.x, 0.0));
    vec3 second = cross(n, first);
    float age = vs_throw[0].y;
    vec3 pull = splash_pull.xyz;
    // The eddies that were there at the hit have gone on with the wind since.
    if (air_gain.w > 0.0) pull += splash_grain.y * eddies(hit + air_wind.xyz * age);
    uint id = floatBitsToUint(seed);
    float number = floor(splash_spray.y + hash_unit(id ^ 0x27D4EB2Fu));
    float fall = dot(n, pull);
    color.a *= 1.0 - smoothstep(0.75 * LONGEST, LONGEST, age);
    for (int k = 0; k < MOST; ++k) {
        if (float(k) >= number || age >= LONGEST) break;
        uint h = hash_word(id + 0x9E3779B9u * uint(k + 1));
        float turn = (float(k) + 0.8 * hash_unit(h)) * (6.28318531 / number) + 40.0 * seed;
        float tilt = splash_spray.w * (0.35 + 0.65 * hash_unit(h ^ 0x85EBCA6Bu));
        float pace = vs_throw[0].x * (0.5 + 0.5 * hash_unit(h ^ 0xC2B2AE35u));
        vec3 across = first * cos(turn) + second * sin(turn);
        vec3 v = (n * cos(tilt) + across * sin(tilt)) * pace;
        float back = fall < 0.0 ? min(-2.0 * dot(n, v) / min(fall, -1e-6), LONGEST) : LONGEST;
        vec3 way = v * age + 0.5 * pull * (age * age);
        vec3 landed = hit + v * back + 0.5 * pull * (back * back);
        // Over the edge of what was hit it falls on, as deep as it is there; else it has landed.
        float deep = -below_surface(shelter_place(landed));
        if (age >= back && (deep < EDGE || -dot(n, way) > deep)) continue;
        // Nor does it fly on through a wall, or in under a roof.
        if (below_surface(shelter_place(hit + way)) > WITHIN) continue;
        droplet(hit + way, v + pull * age, splash_grain.x, color);
    }
}

// What rain meets first at a place.
struct Met {
    vec3 m;       // the place in the map
    vec2 part;    // of it between four texels
    vec4 corners; // depths of these
    float rise;   // m from the place up to the surface
};

bool meet(vec3 at, out Met met)
{
    met.m = shelter_place(at);
    if (!in_shelter_map(met.m)) return false;
    met.corners = shelter_corners(met.m.xy, met.part);
    met.rise = below_corners(met.m, met.corners, met.part);
    return true;
}

float slack(vec3 ridden)
{
    return SNAP + SNAP_SHARE * length(ridden);
}

vec3 onto(Met met, vec3 at)
{
    return at + met.rise * vec3(-shelter_fall.x, 1.0, -shelter_fall.y);
}

// The smaller ones around, each on what rain meets first at its place, and on with that.
void around(vec4 form, vec4 color)
{
    for (int k = 0; k < COMPANIONS; ++k) {
        if (float(k) >= vs_more[0]) break;
        uint id;
        vec4 off = companion(form.w, k, id);
        float age = vs_throw[0].y - off.z;
        float x = age / splash_look.z;
        if (x < 0.0 || x > CROWN_LIFE) continue;
        vec3 at = hit + vec3(off.x, 0.0, off.y);
        Met met;
        if (!meet(at, met)) continue;
        if (vs_ridden[0] != vec3(0.0)) {
            // Beside the thing that its splash rides on, it stays where it was.
            if (abs(met.rise) > WITHIN && !meet(at -= vs_ridden[0], met)) continue;
        } else {
            vec3 v = met_velocity(met.m);
            vec3 on = onto(met, at) + v * age;
            Met there;
            if (v != vec3(0.0) && meet(on, there) && abs(there.rise) < WITHIN) {
                if (abs(there.rise) > slack(v * age)) there.rise = 0.0;
                met = there;
                at = on;
            }
        }
        if (beside_wall(met.m.z - met.rise / shelter_size.y, met.corners)) continue;
        at = onto(met, at);
        vec3 n = corners_normal(met.corners, met.part);
        float above = dot(normalize(camera_position.xyz - at), n);
        lift = clamp(40.0 * above, 0.0, 1.0);
        vec4 own = vec4(off.w * near_size(length(at - camera_position.xyz)), x, 0.0, hash_unit(id));
        film(at, n, own, color);
        crown(at, n, own, vec4(color.rgb, color.a * (1.0 - smoothstep(0.55, 0.92, abs(above)))));
    }
}

void main()
{
    vec4 form = vs_form[0];
    if (form.x <= 0.0) return;
    vec3 n = vs_normal[0];
    hit = vs_at[0];
    float left = 1.0;
    Met met;
    if (meet(hit, met)) {
        if (beside_wall(met.m.z, met.corners)) return;
        if (vs_ridden[0] == vec3(0.0)) left -= smoothstep(GONE, 2.0 * GONE, -met.rise);
        else if (abs(met.rise) < slack(vs_ridden[0])) hit = onto(met, hit);
    }
    float above = dot(normalize(camera_position.xyz - hit), n);
    if (n.y < STEEP && above < 0.0) return;
    lift = clamp(40.0 * above, 0.0, 1.0);
    vec4 color = vs_color[0] * vec4(1.0, 1.0, 1.0, left);
#ifdef SMALL
    crown(hit, n, form, color);
#else
    vec4 near = vec4(color.rgb, vs_throw[0].z);
    vec4 mine = near * vec4(1.0, 1.0, 1.0, left);
    if (mine.a > FAINTEST) film(hit, n, form, mine);
    crown(hit, n, form, color);
    if (mine.a > FAINTEST) droplets(form.w, n, mine);
    if (near.a > FAINTEST && form.z < 0.5) around(form, near);
#endif
}
