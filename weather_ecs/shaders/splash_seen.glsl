// What there is to see of an impact's splash.
#include "impact.glsl"
#include "splash.glsl"

const float THROWN = 0.4;  // m that droplets fly, for culling

struct Seen {
    vec3 at;       // m, where it has come to with what was hit
    float high;    // see stature
    float radius;  // m, of the crown when it has opened
    float pixels;  // the same
    vec3 ray;      // from the camera, unit
    float away;    // m, from the camera
    float x;       // share of its life that is over
    float crown;   // opacity
    float detail;  // opacity of film and droplets
};

// False where nothing is.
bool splash_seen(Impact i, out Seen s)
{
    s = Seen(vec3(0.0), 0.0, 0.0, 0.0, vec3(0.0), 0.0, 0.0, 0.0, 0.0);
    if (i.age >= max(splash_look.z, LONGEST)) return false;
    s.at = i.position + i.ride * i.age;
    vec4 clip = view_projection * vec4(s.at, 1.0);
    if (clip.w < 0.2) return false;
    s.high = stature(i.weight, i.seed);
    s.ray = s.at - camera_position.xyz;
    s.away = length(s.ray);
    s.radius = crown_radius(i.diameter, i.speed, s.high) * near_size(s.away);
    s.pixels = s.radius * camera_position.w / clip.w;
    vec2 margin = (3.0 * s.radius + THROWN) * camera_position.w * 2.0 / view_size.xy;
    if (s.pixels < 0.2 || any(greaterThan(abs(clip.xy), clip.ww + margin))) return false;
    s.ray /= s.away;
    float opacity = splash_look.w * min(i.weight * 0.1, 1.0) * smoothstep(0.2, 0.6, clip.w);
    s.x = i.age / splash_look.z;
    // Seen from above, an upright picture has nothing to show: the film is there then.
    s.crown = opacity * min(s.pixels, 1.0)
        * (1.0 - smoothstep(0.55, 0.92, abs(dot(s.ray, i.normal)))) * step(s.x, CROWN_LIFE);
    s.detail = opacity * (1.0 - smoothstep(0.6 * splash_pull.w, splash_pull.w, clip.w));
    return max(s.crown, s.detail) >= FAINTEST;
}
