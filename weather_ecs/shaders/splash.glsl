// Laws of splashes; physics/splash.py is their oracle, symbol for symbol.
#include <block:Splash>
#include <block:RainView>
#include "hash.glsl"

const float SMALLEST = 0.3;  // factor on its size that the least of the splashes has
const float GREATEST = 2.5;  // the same of the greatest
const float FIRST = 0.25;    // share of its radius that a crown begins with
const float LONGEST = 0.5;   // s that a droplet is seen at most
const int MOST = 5;          // droplets of one splash
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

// Factor on its size that a splash is shown with: one that stands for many real ones is large.
float stature(float weight, float seed)
{
    float chance = max(hash_unit(floatBitsToUint(seed)), 1e-6);
    float s = sqrt(weight * splash_spray.x / chance);
    return clamp(s < 1.0 ? s : sqrt(s), SMALLEST, GREATEST);
}

float growth(float x)
{
    return FIRST + (1.0 - FIRST) * sqrt(x);
}

// Clip space of p, a little nearer to the camera than it is, so that what lies on a surface is not
// half under it. The picture stays the same.
vec4 lifted(vec3 p)
{
    vec4 clip = view_projection * vec4(p, 1.0);
    float nearer = clip.w - min(0.05 + 0.01 * clip.w, 0.5 * clip.w);
    clip.z = (view_depth.y / nearer - view_depth.x) * clip.w;
    return clip;
}
