// What one impact's splash looks like; radius 0 where there is none to draw.
#include "impact.glsl"
#include "splash.glsl"
#include "drop_light.glsl"
#include "encode.glsl"
#include "fog.glsl"

out vec3 vs_at;
out vec3 vs_normal;
out vec4 vs_color;  // encoded, with the crown's opacity
out vec4 vs_form;   // radius in m, share of its life that is over, 1 on water, seed
out vec3 vs_throw;  // speed of the droplets in m/s, age in s, opacity of film and droplets

const float THROWN = 0.4;  // m that droplets fly, for culling

float on_water(vec3 p)
{
    for (int k = 0; k < water_count; ++k) {
        vec4 shape = water_shape[k];
        vec2 e = p.xz - water_axis[k].xy;
        vec2 q = vec2(e.x * water_axis[k].z - e.y * water_axis[k].w,
                      e.x * water_axis[k].w + e.y * water_axis[k].z) / shape.xy;
        float out_by = shape.w > 0.0 ? dot(q, q) : max(abs(q.x), abs(q.y));
        if (out_by < 1.0 && abs(p.y - shape.z) < 0.1) return 1.0;
    }
    return 0.0;
}

void main()
{
    vs_at = vs_normal = vs_throw = vec3(0.0);
    vs_color = vs_form = vec4(0.0);
    gl_Position = vec4(0.0);
    Impact i;
    if (!read_impact(i) || i.age >= max(splash_look.z, LONGEST)) return;
    vec4 clip = view_projection * vec4(i.position, 1.0);
    if (clip.w < 0.2) return;
    float high = stature(i.weight, i.seed);
    float radius = crown_radius(i.diameter, i.speed, high);
    float pixels = radius * camera_position.w / clip.w;
    vec2 margin = (3.0 * radius + THROWN) * camera_position.w * 2.0 / view_size.xy;
    if (pixels < 0.2 || any(greaterThan(abs(clip.xy), clip.ww + margin))) return;

    vec3 ray = i.position - camera_position.xyz;
    float away = length(ray);
    ray /= away;
    float opacity = splash_look.w * min(i.weight * 0.1, 1.0) * smoothstep(0.2, 0.6, clip.w);
    float x = i.age / splash_look.z;
    // Seen from above, an upright picture has nothing to show: the film is there then.
    float crown = opacity * min(pixels, 1.0)
        * (1.0 - smoothstep(0.55, 0.92, abs(dot(ray, i.normal)))) * step(x, CROWN_LIFE);
    float detail = opacity * (1.0 - smoothstep(0.6 * splash_pull.w, splash_pull.w, clip.w));
    if (max(crown, detail) < FAINTEST) return;
    vs_at = i.position;
    vs_normal = i.normal;
    vs_color = vec4(encode(in_fog(drop_light(i.position, ray), away)), crown);
    vs_form = vec4(radius, x, on_water(i.position), i.seed);
    vs_throw = vec3(i.speed * splash_spray.z * min(high, 1.0), i.age, detail);
}
