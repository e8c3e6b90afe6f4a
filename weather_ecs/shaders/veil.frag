// Optical depth of the rain along the view ray inside the elliptical cylinders of areas, less what
// the drops near the observer already show. With f an ellipse's implicit function along the ray, a
// quadratic in t, the rain rate's share is (1 - f) / (1 - f_in), at most 1: its integral is closed.
// physics/veil.py is the oracle. CHANGING: of rain that begins or ends. EMPTY: before nothing.
// SCENE: for a texel that stands for several pixels of the scene. ALONE: one area, whose vertices say
// how it lies; BELOW: seen from below its ceiling. DARKER: thick rain under a cloud is darker.
#include <block:RainView>
#include <block:Veil>
#include "fog.glsl"
#include "grain.glsl"
#include "rain_front.glsl"
#include "veil_axes.glsl"

uniform sampler2D scene_depth;

noperspective in vec3 vs_ray;
noperspective in vec2 vs_place;
#ifdef ALONE
noperspective in vec4 vs_own;
noperspective in float vs_rise;
// A software driver fetches a block's numbers anew for every few pixels; these it has at hand.
flat in vec4 vs_load;   // as veil_load; y: level of f of the full rate
flat in vec4 vs_shown;  // as veil_shown; z, w: view_depth
flat in vec4 vs_tint;
flat in vec4 vs_fog;    // as fog_shown; w: its extinction
#ifdef CURTAIN
flat in vec4 vs_curtain;
#endif
#endif
out vec4 color;

// Integral over [x0, x1] of max(h - x^2, 0), h2 = max(h, 0).
float over_level(float h2, float x0, float x1)
{
    float half_chord = sqrt(h2);
    x0 = clamp(x0, -half_chord, half_chord);
    x1 = clamp(x1, -half_chord, half_chord);
    return (x1 - x0) * (h2 - (x0 * x0 + x0 * x1 + x1 * x1) * (1.0 / 3.0));
}

// The same integral where rain begins or ends, in parts: in each the share that has come down is that
// at its middle. fall: m below the ceiling where x = 0.
const int PARTS = 6;

float changing_path(
    float outer, float inner, float x0, float x1, float fall, float rise, vec4 dry, float slope
)
{
    float half_chord = sqrt(outer);
    x0 = clamp(x0, -half_chord, half_chord);
    x1 = clamp(x1, -half_chord, half_chord);
    float path = 0.0;
    for (int i = 0; i < PARTS; ++i) {
        float a = mix(x0, x1, float(i) / float(PARTS));
        float b = mix(x0, x1, float(i + 1) / float(PARTS));
        float share = extinction_arrived(fall - rise * 0.5 * (a + b), dry, slope);
        path += share * (over_level(outer, a, b) - over_level(inner, a, b));
    }
    return path;
}

// -1 to 1, smooth, of period 1.
float wave(float x)
{
    float y = abs(fract(x) * 2.0 - 1.0);
    return y * y * (6.0 - 4.0 * y) - 1.0;
}

// Rays of rain within a shaft, seen from afar; u: shares of its half width.
float rays_of_rain(float u)
{
    return 0.5 * wave(u * 0.83) + 0.35 * wave(u * 2.17 + 0.37) + 0.15 * wave(u * 5.71 + 0.71);
}

#ifdef ALONE
#define FULL(i) vs_load.y
#define LOAD(i) vs_load
#define SHOWN_TO(i) vs_shown
#define TINT(i) vs_tint
#define CURTAIN_OF(i) vs_curtain
#define FOG vs_fog.rgb
#define DEPTH vs_shown.zw

float left_of(float distance)
{
    return exp2(-vs_fog.w * distance);
}
#else
#define FULL(i) veil_from[i].z
#define LOAD(i) veil_load[i]
#define SHOWN_TO(i) veil_shown[i]
#define TINT(i) veil_tint[i]
#define CURTAIN_OF(i) veil_curtain[i]
#define FOG fog_shown.rgb
#define DEPTH view_depth
#define left_of fog_left
#endif

// Of one area: its light times its optical depth (ALONE: its light), and that depth. The index is a constant wherever this is
// called: a software driver gathers what a variable one asks for, at four times the cost.
vec4 seen_of(int i, vec3 ray, float end, float rise, float over_rise, float per_t, float over_t)
{
    vec4 load = LOAD(i);
#ifdef BELOW
    float t0 = 0.0;
    float t1 = end * vs_rise > 1.0 ? 1.0 / vs_rise : end;
#else
    float cut = load.z * over_rise;
    float t0 = rise > 0.0 ? 0.0 : max(cut, 0.0);
    float t1 = rise > 0.0 ? min(end, cut) : end;
#endif

#ifdef SHOWN
    // The drops' share falls from 1 at the observer to 0 at the distance veil_shown, overhead too:
    // by the level distance alone, there would be a hole in the veil at the zenith.
    float shown = SHOWN_TO(i).x * over_t;
    float x = min(t1 * per_t * SHOWN_TO(i).y, 1.0);
    t0 = max(t0, shown * x * (1.0 - 0.5 * x));
#endif

    // f(t) = lowest + a (t - middle)^2. The ray's distance from the middle comes from the cross
    // product: as a difference it would drown where a thin area is far off.
#ifdef ALONE
    vec4 lies = vs_own;
#else
    vec4 lies = on_axes(i, ray);
#endif
    vec2 own = lies.xy;
    float a = max(dot(own, own), 1e-12);
    float over_a = 1.0 / a;
    float middle = lies.z * over_a;
    float aside = lies.w;
    float lowest = aside * aside * over_a;
    float outer = max((1.0 - lowest) * over_a, 0.0);
    float inner = max((FULL(i) - lowest) * over_a, 0.0);
    float half_chord = sqrt(outer);
    float x0 = t0 - middle;
    float x1 = max(t1 - middle, x0);
#ifdef CHANGING
    float path = changing_path(
        outer, inner, x0, x1, load.z - ray.y * middle, ray.y, veil_dry[i], veil_from[i].w
    );
#else
    float path = over_level(outer, x0, x1) - over_level(inner, x0, x1);
#endif
    float optical = load.x * path * per_t * a;
    float near = max(x0, -half_chord);
    float far = max(min(x1, half_chord), near);

#ifdef CURTAIN
    // Thin below the cloud; and from afar rays of rain, which the wind slants, ragged at the sides.
    float fall = load.z - ray.y * (middle + 0.5 * (near + far));
    vec4 curtain = CURTAIN_OF(i);
    float drift = (curtain.z * own.y - curtain.w * own.x) * fall;  // of what fell straight
    float u = (aside - drift) * sqrt(over_a);
    float rays = curtain.x * (0.35 + 0.55 * min(lowest, 1.0)) * rays_of_rain(u + curtain.y);
    optical *= clamp(fall * load.w, 0.0, 1.0) * (1.0 + rays);
#endif

    // What there is to see of the rain lies about one optical depth deep in it, at most in its
    // middle.
    float along = near + (far - near) / (2.0 + optical);
    vec4 tint = TINT(i);
    vec3 own_light = tint.rgb;
#ifdef DARKER
    own_light *= 1.0 - tint.a * optical / (1.0 + optical);
#endif
    own_light = mix(FOG, own_light, left_of((along + middle) * per_t));
#ifdef ALONE
    return vec4(own_light, optical);
#else
    return vec4(own_light, 1.0) * optical;
#endif
}

#ifdef SCENE
// Depth in m of the farthest thing of a few around a texel. What is nearer has less than its share of
// the rain then, and not too much: no halo about a post before a far shaft.
const float NOTHING = 4000.0;  // m, where there is none among them

float farthest()
{
    ivec2 size = textureSize(scene_depth, 0);
    ivec2 at = ivec2(vs_place * vec2(size));
    float far = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(at + ivec2(i & 1, i >> 1) * 4 - 2, ivec2(0), size - 1);
        float depth = texelFetch(scene_depth, texel, 0).r;
        far = depth < 1.0 ? max(far, depth) : far;
    }
    return far > 0.0 ? view_depth.y / (far * 2.0 - 1.0 + view_depth.x) : NOTHING;
}
#endif

void main()
{
    vec3 ray = vs_ray;
#if defined(EMPTY)
    float end = 1e5;
#elif defined(SCENE)
    float end = farthest();
#else
    float depth = texture(scene_depth, vs_place).r;
    float end = depth >= 1.0 ? 1e5 : DEPTH.y / (depth * 2.0 - 1.0 + DEPTH.x);
#endif
    float rise = abs(ray.y) < 1e-6 ? 1e-6 : ray.y;
    float over_rise = 1.0 / rise;
    float over_t = inversesqrt(dot(ray, ray));
    float per_t = dot(ray, ray) * over_t;
    vec4 seen = seen_of(0, ray, end, rise, over_rise, per_t, over_t);
#if COUNT > 1
    seen += seen_of(1, ray, end, rise, over_rise, per_t, over_t);
    seen += seen_of(2, ray, end, rise, over_rise, per_t, over_t);
    seen += seen_of(3, ray, end, rise, over_rise, per_t, over_t);
#endif
#ifdef SCENE
    color = seen * (1e3 / end);  // for a km of depth
#else
    float opacity = 1.0 - exp(-seen.a);
#ifdef ALONE
    vec3 own_light = seen.rgb;
#else
    vec3 own_light = seen.rgb / max(seen.a, 1e-9);
#endif
    color = vec4(own_light + pixel_grain() / max(opacity, 0.05), opacity);
#endif
}
