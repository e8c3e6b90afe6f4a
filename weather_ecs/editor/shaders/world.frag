#version 330
#include "weather.glsl"
#include "wetness.glsl"
#include "cloud_shadow.glsl"
#include "sky.glsl"

uniform vec3 eye;
uniform sampler2D land_map;   // square roots of linear RGB, LAND m on a side, repeated
uniform sampler2D grain_map;  // noise of three scales

const float LAND = 24000.0;

in vec3 v_away;
in vec3 v_normal;
in vec4 v_color;

out vec4 out_color;

const vec3 DRY = vec3(0.155, 0.140, 0.058), LUSH = vec3(0.062, 0.105, 0.032);
const vec3 SAND = vec3(0.235, 0.195, 0.140);

// How much of a place is the lane from the green to the church: two ruts, grass between them.
float lane(vec2 p, vec3 grain)
{
    float across = abs(p.x + 4.0 - 5.0 * sin(p.y / 38.0)) + 0.7 * grain.g;
    float rut = smoothstep(1.15, 0.75, across) * (0.45 + 0.55 * smoothstep(0.15, 0.45, across));
    return rut * smoothstep(-121.0, -113.0, p.y) * smoothstep(150.0, 90.0, p.y);
}

// The level ground round the origin is one green, fields lie beyond; grain near the eye.
vec3 land(vec3 meadow, vec2 p, float away)
{
    vec3 grain = texture(grain_map, p / 37.0).rgb - 0.5;
    vec3 fields = texture(land_map, p / LAND + 0.5).rgb;
    float tilled = smoothstep(340.0, 400.0, length(p) + 80.0 * grain.b);
    // Tufts and bare spots of some metres, swards of some tens; blades near the eye.
    vec3 broad = texture(grain_map, p / 260.0).rgb - 0.5;
    float sward = clamp(0.5 + 0.9 * broad.b + 0.7 * broad.g + 0.5 * grain.b, 0.0, 1.0);
    vec3 green = mix(mix(LUSH, meadow, smoothstep(0.1, 0.5, sward)), DRY,
                     0.6 * smoothstep(0.62, 0.95, sward));
    green = mix(green, SAND * (1.0 + 0.4 * grain.r), 0.85 * lane(p, grain));
    vec3 soil = mix(green, fields * fields, tilled);
    float fine = texture(grain_map, p / 7.3).r - 0.5;
    float blades = texture(grain_map, p / 1.9).r - 0.5;
    return soil * (1.0 + 0.35 * grain.g + 0.5 * fine * exp(-away / 30.0)
                   + 0.7 * blades * exp(-away / 9.0));
}

void main()
{
    float away = length(v_away);
    vec3 p = eye + v_away, normal = normalize(v_normal), way = v_away / max(away, 1e-4);
    vec3 base = v_color.a > 0.5 ? land(v_color.rgb, p.xz, away) : v_color.rgb;
    float damp = weather_damp(weather_wetness(p, normal));
    float snow = weather_snow_cover(weather_snow(p, normal));
    base = mix(base * (1.0 - 0.42 * damp), vec3(0.86, 0.88, 0.92), snow);
    float lit = weather_sunlight(p);
    vec3 light = base * (weather_light(normal, lit) + weather_flash(p, normal));
    float glance = pow(1.0 - max(dot(normal, -way), 0.0), 5.0);
    float gloss = damp * (1.0 - snow) * (v_color.a > 0.5 ? 0.4 * texture(grain_map, p.xz / 23.0).b : 0.3);
    light = mix(light, weather_sky(reflect(way, normal)), gloss * (0.04 + 0.96 * glance));
    out_color = vec4(pow(max(weather_fog(light, away), 0.0), vec3(1.0 / 2.2)), 1.0);
}
