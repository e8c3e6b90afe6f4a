// Optical depth of the rain along the view ray inside an area's elliptical cylinder, less what the
// drops near the observer already show. With f the ellipse's implicit function along the ray, a
// quadratic in t, the rain rate's share is (1 - f) / (1 - f_in), at most 1: its integral is closed.
#include <block:RainView>
#include <block:Veil>
#include "encode.glsl"

uniform sampler2D scene_depth;

in vec3 vs_ray;
out vec4 color;

// Integral over [t0, t1] of max(level - f(t), 0), f(t) = lowest + a (t - middle)^2.
float over_level(float level, float lowest, float a, float middle, float t0, float t1)
{
    float h = level - lowest;
    if (h <= 0.0) return 0.0;
    float half_chord = sqrt(h / a);
    float x0 = clamp(t0 - middle, -half_chord, half_chord);
    float x1 = clamp(t1 - middle, -half_chord, half_chord);
    return (x1 - x0) * (h - a * (x0 * x0 + x0 * x1 + x1 * x1) * (1.0 / 3.0));
}

void main()
{
    vec3 ray = vs_ray / dot(vs_ray, camera_forward.xyz);
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy - view_origin.xy), 0).r;
    float t1 = depth >= 1.0 ? 1e5 : view_depth.y / (depth * 2.0 - 1.0 + view_depth.x);
    float t0 = 0.0;
    float rise = abs(ray.y) < 1e-6 ? 1e-6 : ray.y;
    float cut = (veil_span.y - camera_position.y) / rise;
    if (rise > 0.0) t1 = min(t1, cut);
    else t0 = max(t0, cut);

    vec2 o = camera_position.xz - veil_axis.xy;
    vec2 o2 = vec2(o.x * veil_axis.z - o.y * veil_axis.w, o.x * veil_axis.w + o.y * veil_axis.z)
        / veil_shape.xy;
    vec2 r2 = vec2(ray.x * veil_axis.z - ray.z * veil_axis.w,
                   ray.x * veil_axis.w + ray.z * veil_axis.z) / veil_shape.xy;
    float a = max(dot(r2, r2), 1e-12);
    float middle = -dot(o2, r2) / a;
    // The ray's distance from the middle, squared. As o2 . o2 - a middle^2 it would be the small
    // difference of two large numbers where a thin area is far off.
    float aside = o2.x * r2.y - o2.y * r2.x;
    float lowest = aside * aside / a;

    // The drops' share falls from 1 at the observer to 0 at the distance veil_load.y.
    float level = length(ray.xz);
    float shown = veil_load.y / max(level, 1e-4);
    float x = min(t1 / max(shown, 1e-4), 1.0);
    t0 = max(t0, veil_load.y > 0.0 ? shown * x * (1.0 - 0.5 * x) : 0.0);
    if (t1 <= t0) discard;

    float inner = veil_shape.z;
    float path = (over_level(1.0, lowest, a, middle, t0, t1)
        - over_level(inner, lowest, a, middle, t0, t1)) / (1.0 - inner);
    float opacity = 1.0 - exp(-veil_load.x * path * length(ray));
    if (opacity < 0.002) discard;
    // A pixel's own grain, under one step of an 8-bit target, keeps the soft ramp from banding.
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    color = vec4(veil_color.rgb + (grain - 0.5) * (1.6 / 255.0) / max(opacity, 0.05), opacity);
}
