// Optical depth of the rain along the view ray inside an area's elliptical cylinder, less what the
// drops near the observer already show. With f the ellipse's implicit function along the ray, a
// quadratic in t, the rain rate's share is (1 - f) / (1 - f_in), at most 1: its integral is closed.
#include <block:RainView>
#include <block:Veil>
#include "fog.glsl"
#include "rain_front.glsl"

uniform sampler2D scene_depth;

in vec3 vs_ray;
in vec4 vs_own;
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
// at its middle. y: height in m of the ray where x = 0.
const int PARTS = 6;

float changing_path(float outer, float inner, float x0, float x1, float y, float rise)
{
    float half_chord = sqrt(outer);
    x0 = clamp(x0, -half_chord, half_chord);
    x1 = clamp(x1, -half_chord, half_chord);
    float path = 0.0;
    for (int i = 0; i < PARTS; ++i) {
        float a = mix(x0, x1, float(i) / float(PARTS));
        float b = mix(x0, x1, float(i + 1) / float(PARTS));
        float fall = veil_span.y - (y + rise * 0.5 * (a + b));
        float share = extinction_arrived(fall, veil_dry, veil_load.z);
        path += share * (over_level(outer, a, b) - over_level(inner, a, b));
    }
    return path;
}

void main()
{
    // Per unit of depth along the camera's forward axis.
    float per_depth = 1.0 / dot(vs_ray, camera_forward.xyz);
    vec3 ray = vs_ray * per_depth;
    vec4 own = vs_own * per_depth;
    // Where the host has no depth, one texel stands for all.
    ivec2 texel = min(ivec2(gl_FragCoord.xy - view_origin.xy), textureSize(scene_depth, 0) - 1);
    float depth = texelFetch(scene_depth, texel, 0).r;
    float t1 = depth >= 1.0 ? 1e5 : view_depth.y / (depth * 2.0 - 1.0 + view_depth.x);
    float t0 = 0.0;
    float rise = abs(ray.y) < 1e-6 ? 1e-6 : ray.y;
    float cut = (veil_span.y - camera_position.y) / rise;
    if (rise > 0.0) t1 = min(t1, cut);
    else t0 = max(t0, cut);

    // The drops' share falls from 1 at the observer to 0 at the distance veil_load.y, overhead too:
    // by the level distance alone, there would be a hole in the veil at the zenith.
    float length2 = dot(ray, ray);
    if (veil_load.y > 0.0) {
        float shown = veil_load.y * inversesqrt(length2);
        float x = min(t1 / shown, 1.0);
        t0 = max(t0, shown * x * (1.0 - 0.5 * x));
    }
    if (t1 <= t0) discard;

    // f(t) = lowest + a (t - middle)^2. The ray's distance from the middle comes from the cross
    // product: as a difference it would drown where a thin area is far off.
    float over_a = 1.0 / max(dot(own.xy, own.xy), 1e-12);
    float middle = -own.z * over_a;
    float lowest = own.w * own.w * over_a;
    float outer = max((1.0 - lowest) * over_a, 0.0);
    float inner = max((veil_shape.z - lowest) * over_a, 0.0);
    t0 -= middle;
    t1 -= middle;
    float path;
    if (veil_dry == SETTLED) path = over_level(outer, t0, t1) - over_level(inner, t0, t1);
    else path = changing_path(outer, inner, t0, t1, camera_position.y + ray.y * middle, ray.y);
    float per_t = sqrt(length2);
    path *= per_t / (over_a * (1.0 - veil_shape.z));
    float optical = veil_load.x * path;
    float opacity = 1.0 - exp(-optical);
    if (opacity < 0.002) discard;
    // What there is to see of the rain lies about one optical depth deep in it, at most in its middle.
    float half_chord = sqrt(outer);
    float near = max(t0, -half_chord);
    float along = near + (min(t1, half_chord) - near) / (2.0 + optical);
    vec3 shown = mix(fog_shown.rgb, veil_tint.rgb, fog_left((along + middle) * per_t));
    // A pixel's own grain, under one step of an 8-bit target, keeps the soft ramp from banding.
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    color = vec4(shown + (grain - 0.5) * (1.6 / 255.0) / max(opacity, 0.05), opacity);
}
