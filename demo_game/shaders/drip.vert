// Drops off an eave, a quad each: a streak as it falls, then what it throws up where it lands. Which
// drops there are follows from the time and the water on the roof alone, so that nothing is kept.
#include "frame.glsl"
#include "light.glsl"
#include "lot.glsl"

in vec2 in_corner;   // -1..1 across, 0..1 along
in vec4 in_drip;     // xyz m, w height of what stops it
in float in_lamp;    // light of lamps

uniform vec3 lens;       // normalised coordinates a pixel, across and up; pixels a metre at 1 m

out vec2 v_corner;
out vec4 v_color;         // linear light, opacity
flat out float v_landed;  // 1 what it throws up

const float PULL = 9.81;     // m/s2
const float MORE = 0.5;      // s at most, that the next one waits when a drop has gone
const float THROWN = 0.22;   // s that a splash is seen
const float WIDE = 0.0048;   // m, of a drop that an edge lets go
const float TALL = 0.06;    // m, of what it throws up
const float HALF = 0.16;     // mm of water on open ground at which half the drops are there
const float EXPOSURE = 0.04;  // s

void main() {
    vec3 p = in_drip.xyz;
    float tall = max(p.y - in_drip.w, 0.1);
    float falls = sqrt(2.0 * tall / PULL);
    uint id = hash_word(uint(gl_InstanceID) + 1u);
    float period = falls + THROWN + MORE * hash_unit(id);
    float turns = camera.w / period + hash_unit(id ^ 0x27D4EB2Fu);
    float age = fract(turns) * period;
    uint own = hash_word(id + uint(int(floor(turns))));
#ifdef WATER
    float water = weather_open_wetness(p);
#else
    float water = 1.1 * rain_cover(p.xz).y;
#endif
    v_corner = in_corner;
    v_landed = age > falls ? 1.0 : 0.0;
    v_color = vec4(0.0);
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    if (hash_unit(own) >= water / (water + HALF) || age > falls + THROWN) return;

    // Wind takes it along the more, the longer it falls.
    float blown = gusts[0].x * gusts[0].x * 0.06;
    vec3 pull = vec3(wind.x * blown, -PULL, wind.y * blown);
    float size = 0.75 + 0.5 * hash_unit(own ^ 0x85EBCA6Bu);
    vec3 at = p + 0.5 * pull * min(age, falls) * min(age, falls);
    float away = distance(camera.xyz, at);
    float scale = lens.z / away;  // pixels a metre
    vec3 light = sky_light(vec3(0.0, 1.0, 0.0), rain_cover(p.xz).x);
    light += LAMP_COLOR * (LAMP_STRENGTH * in_lamp * sun_direction.w);
    light += flash_light(at, vec3(0.0, 1.0, 0.0));
    float opacity;
    vec4 clip;
    if (v_landed < 0.5) {
        float before = max(age - EXPOSURE, 0.0);
        vec3 tail = p + 0.5 * pull * before * before;
        vec4 a = view_projection * vec4(tail, 1.0), b = view_projection * vec4(at, 1.0);
        if (min(a.w, b.w) < 0.1) return;
        vec2 along = (b.xy / b.w - a.xy / a.w) / lens.xy;
        along = length(along) > 1e-3 ? normalize(along) : vec2(0.0, -1.0);
        float pixels = WIDE * size * scale;
        float wide = max(pixels, 1.3);
        opacity = 0.7 * min(pixels / 1.3, 1.0) * smoothstep(0.3, 0.9, away);
        clip = mix(a, b, in_corner.y);
        clip.xy += vec2(-along.y, along.x) * (in_corner.x * 0.5 * wide * clip.w) * lens.xy;
    } else {
        float share = (age - falls) / THROWN;
        float reach = TALL * size * (0.35 + 0.65 * sqrt(share));
        opacity = 0.5 * (1.0 - share) * smoothstep(1.5, 4.0, reach * scale);
        vec3 side = normalize(vec3(camera.z - at.z, 0.0, at.x - camera.x));
        vec3 q = at + side * (in_corner.x * reach) + vec3(0.0, in_corner.y * reach, 0.0);
        clip = view_projection * vec4(q, 1.0);
    }
    vec4 air = haze(at);
    v_color = vec4(light * air.a + air.rgb, opacity);
    gl_Position = clip;
}
