// Rings on puddles, a point each: at every place one begins with a beat of its own or does not, by
// lot and as thick as rain falls. How much of a puddle there is, is asked as ground.frag does.
#include "frame.glsl"
#include "light.glsl"
#include "sky_map.glsl"
#include "puddle_rise.glsl"
#include "lot.glsl"

in vec3 in_place;  // m

uniform sampler2D detail_map;
uniform sampler2D sky_map;
uniform float reach;  // m from the camera
uniform float lens;   // pixels a metre at 1 m

flat out vec4 v_ring;     // what it mirrors, display values; opacity
flat out vec2 v_age;      // 0..1; pixels of its width in one of its height

const float BEATS = 2.4;      // a second, of one place
const float ASIDE = 0.12;     // m, from the place
const float LEAST = 0.05;     // m that the smallest ring runs, and the others more
const float MORE = 0.09;

void main() {
    uint id = hash_word(uint(gl_VertexID) + 1u);
    float beats = BEATS * camera.w + hash_unit(id);
    uint own = hash_word(id + uint(int(floor(beats))));
    v_age = vec2(fract(beats), 1.0);
    v_ring = vec4(0.0);
    gl_PointSize = 1.0;
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    vec2 aside = vec2(hash_unit(own ^ 0x27D4EB2Fu), hash_unit(own ^ 0x85EBCA6Bu)) - 0.5;
    vec3 p = in_place + vec3(aside.x, 0.0, aside.y) * (2.0 * ASIDE);
    if (hash_unit(own) >= rain_falls(p.xz)) return;

    float grain = textureLod(detail_map, p.xz * 0.155, 0.0).a - 0.5;
#ifdef WATER
    float water = weather_water_at(weather_wet_place(p), p.y, weather_open_wetness(p));
    float puddle = weather_pooled(water, 5.0 - 12.5 * grain + puddle_rise(p.xz));
#else
    float puddle = clamp(grain * 8.5 + 0.35, 0.0, 1.0) * rain_cover(p.xz).y;
#endif
    vec3 view = camera.xyz - p;
    float away = length(view);
    view /= away;
    vec3 mirrored = view * vec3(-1.0, 1.0, -1.0);
    float grazing = 1.0 - max(view.y, 0.0);
    float share = sqrt(0.02 + 0.98 * grazing * grazing * grazing * grazing * grazing);
    v_ring.rgb = flash_on_sky(textureLod(sky_map, sky_uv_unit(mirrored), 0.0).rgb, flash_left());
    float haze_left = exp(-away * horizon_color.w);
    v_ring.a = puddle * (1.0 - v_age.x) * min(0.18 + share, 1.0) * haze_left
        * clamp(3.0 - 3.0 * away / reach, 0.0, 1.0);
    if (v_ring.a < 0.02) return;

    float radius = LEAST + MORE * hash_unit(own ^ 0xC2B2AE35u);
    v_age.y = 1.0 / max(view.y, 0.1);  // lies flat
    gl_PointSize = max(2.0 * radius * lens / away, 1.0);
    // A point has one depth: that of the rim before it, so that the ground leaves all of it.
    gl_Position = view_projection * vec4(p, 1.0);
    vec4 rim = view_projection * vec4(p + view * (1.3 * radius), 1.0);
    gl_Position.z = rim.z / rim.w * gl_Position.w;
}
