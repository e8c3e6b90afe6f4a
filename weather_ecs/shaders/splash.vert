// What one impact's splash looks like; radius 0 where there is none to draw.
#include "splash_seen.glsl"
#include "drop_light.glsl"
#include "encode.glsl"
#include "fog.glsl"

out vec3 vs_at;
out vec3 vs_normal;
out vec4 vs_color;  // encoded, with the crown's opacity
out vec4 vs_form;   // radius in m, share of its life that is over, 1 on water, seed
out vec3 vs_throw;  // speed of the droplets in m/s, age in s, opacity of film and droplets
out float vs_more;  // companions
out vec3 vs_ridden; // m that it has gone with what was hit

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
    vs_at = vs_normal = vs_throw = vs_ridden = vec3(0.0);
    vs_more = 0.0;
    vs_color = vs_form = vec4(0.0);
    gl_Position = vec4(0.0);
    Impact i;
    Seen s;
    if (!read_impact(i) || !splash_seen(i, s)) return;
    vs_at = s.at;
    vs_ridden = s.at - i.position;
    vs_normal = i.normal;
    vs_color = vec4(encode(in_fog(drop_light(s.at, s.ray), s.away)), s.crown);
    vs_form = vec4(s.radius, s.x, on_water(s.at), i.seed);
    vs_throw = vec3(i.speed * splash_spray.z * min(s.high, 1.0), i.age, s.detail);
    vs_more = companions(i.weight, i.seed);
}
