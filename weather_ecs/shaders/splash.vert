// What one impact's splash looks like; radius 0 where there is none to draw. With DETAIL: the film
// and the droplets of those that are close by, without: the crown.
#include "impact.glsl"
#include "splash.glsl"
#include "drop_light.glsl"
#include "encode.glsl"

out vec3 vs_at;
out vec3 vs_normal;
out vec4 vs_color;  // encoded, with opacity
out vec4 vs_form;   // radius in m, share of its life that is over, kind (1 on water), seed
#ifdef DETAIL
out vec2 vs_throw;  // speed of the droplets in m/s, age in s
const float REACH = 0.5;  // m that droplets fly, for culling
#else
const float REACH = 0.0;
#endif

float on_water(vec3 p)
{
    for (int k = 0; k < water_count; ++k) {
        vec2 e = p.xz - water_axis[k].xy;
        vec2 q = vec2(e.x * water_axis[k].z - e.y * water_axis[k].w,
                      e.x * water_axis[k].w + e.y * water_axis[k].z);
        if (all(lessThan(abs(q), water_shape[k].xy)) && abs(p.y - water_shape[k].z) < 0.1)
            return 1.0;
    }
    return 0.0;
}

void main()
{
    vs_at = vs_normal = vec3(0.0);
    vs_color = vs_form = vec4(0.0);
#ifdef DETAIL
    vs_throw = vec2(0.0);
    float life = max(splash_look.z, LONGEST);
#else
    float life = 0.95 * splash_look.z;  // the texture's last frame is empty
#endif
    gl_Position = vec4(0.0);
    Impact i;
    if (!read_impact(i) || i.age >= life) return;
    vec4 clip = view_projection * vec4(i.position, 1.0);
    if (clip.w < 0.2) return;
    float high = stature(i.weight, i.seed);
    float radius = bounded_radius(i.diameter, i.speed) * high;
    float pixels = radius * camera_position.w / clip.w;
    vec2 margin = (3.0 * radius + REACH) * camera_position.w * 2.0 / view_size.xy;
    if (any(greaterThan(abs(clip.xy), clip.ww + margin))) return;

    vec3 ray = normalize(i.position - camera_position.xyz);
    float opacity = splash_look.w * min(i.weight * 0.1, 1.0) * smoothstep(0.2, 0.6, clip.w);
#ifdef DETAIL
    opacity *= 1.0 - smoothstep(0.6 * splash_pull.w, splash_pull.w, clip.w);
    vs_throw = vec2(i.speed * splash_spray.z * high, i.age);
#else
    // Seen from above, an upright picture has nothing to show: the film is there then.
    opacity *= min(pixels, 1.0) * (1.0 - smoothstep(0.8, 0.98, abs(dot(ray, i.normal))));
#endif
    if (opacity < 0.004 || pixels < 0.2) return;
    vs_at = i.position;
    vs_normal = i.normal;
    vs_color = vec4(encode(drop_light(i.position, ray)), opacity);
    vs_form = vec4(radius, i.age / splash_look.z, on_water(i.position), i.seed);
}
