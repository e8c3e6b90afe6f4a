// Laws of splashes; physics/splash.py is their oracle, symbol for symbol.
#include <block:Splash>
#include <block:RainView>
#include "hash.glsl"

const float SMALLEST = 0.3;  // factor on its size that the least of the splashes has
const float GREATEST = 2.5;  // the same of the greatest
const float FIRST = 0.25;    // share of its radius that a crown begins with
const float LONGEST = 0.5;   // s that a droplet is seen at most
const int MOST = 5;          // droplets of one splash
const int COMPANIONS = 6;    // most of them that one splash has
const float PLENTY = 3.0;    // so many times as many are small as are full-grown
const float SCATTER = 0.8;   // m that they lie off at most
const float NEAREST = 0.7;  // factor on the size of a splash at NEAR or closer; 1 at FAR
const float NEAR = 1.5;     // m
const float FAR = 8.0;
const float FAINTEST = 0.004;   // opacity below which nothing is drawn
// Shares of the life from which on the texture of a crown and of a film is empty.
const float CROWN_LIFE = 0.93;
const float FILM_LIFE = 0.56;

// Greatest radius of a drop's water, D We^(1/4) / 2, in m, as it is drawn: larger by the look and
// by `high`, within a bound. D in mm, v in m/s.
float crown_radius(float diameter, float speed, float high)
{
    float weber = speed * speed * diameter / 0.0728;
    float radius = 0.5e-3 * diameter * pow(weber, 0.25) * splash_look.x * high;
    return splash_look.y * (1.0 - exp(-radius / splash_look.y));
}

// Factor on its size that a splash so many m away has: they grow with distance, as drops do.
float near_size(float away)
{
    return mix(NEAREST, 1.0, smoothstep(NEAR, FAR, away));
}

// Factor on its size that a splash is shown with: one that stands for many real ones is large.
float stature(float weight, float seed)
{
    float chance = max(hash_unit(floatBitsToUint(seed)), 1e-6);
    float s = sqrt(weight * splash_spray.x / chance);
    return clamp(s < 1.0 ? s : sqrt(s), SMALLEST, GREATEST);
}

// Number of small splashes around one whose drop stands for more of them than itself.
float companions(float weight, float seed)
{
    float more = PLENTY * weight * splash_spray.x - 1.0;
    float chance = hash_unit(floatBitsToUint(seed) ^ 0x165667B1u);
    return clamp(floor(more + chance), 0.0, float(COMPANIONS));
}

// Companion k: where it is off the hit along x and z in m, how much later in s, the radius of its own
// drop's water in m; `id` is of itself.
vec4 companion(float seed, int k, out uint id)
{
    id = hash_word(floatBitsToUint(seed) + 0x9E3779B9u * uint(k + 11));
    float turn = 6.28318531 * hash_unit(id ^ 0x27D4EB2Fu);
    float off = SCATTER * sqrt(hash_unit(id ^ 0x85EBCA6Bu));
    float later = max(LONGEST - splash_look.z, 0.0) * hash_unit(id ^ 0xC2B2AE35u);
    float diameter = 0.8 + 1.4 * hash_unit(id);
    float radius = crown_radius(diameter, 9.65 - 10.3 * exp(-0.6 * diameter), 1.0);
    return vec4(off * cos(turn), off * sin(turn), later, radius);
}

float growth(float x)
{
    return FIRST + (1.0 - FIRST) * sqrt(x);
}

// Clip space of p, a little nearer to the camera than it is (`lift` 1), so that what lies on a surface
// is not half under it; where the camera is under the surface itself (0), where it is, so that no
// ceiling shows what is on the roof. The picture stays the same.
float lift = 1.0;

vec4 lifted(vec3 p)
{
    vec4 clip = view_projection * vec4(p, 1.0);
    float nearer = clip.w - lift * min(0.05 + 0.01 * clip.w, 0.5 * clip.w);
    clip.z = (view_depth.y / nearer - view_depth.x) * clip.w;
    return clip;
}
