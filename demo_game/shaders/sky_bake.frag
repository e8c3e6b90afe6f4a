// Paints the sky's map: gradient, sun, mist. Its clouds are the weather's, drawn over it; of a closed
// cover it has the grey.
#include "frame.glsl"
#include "sky_map.glsl"
#include "tone.glsl"
#include "fog_light.glsl"
#include "sky.glsl"

uniform float has_sky;  // 1 where the weather has one by direction

in vec2 v_uv;
out vec4 out_color;

float hash(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

// Clear air: gradient, the sun and its glow.
vec3 air(vec3 d) {
    float up = max(d.y, 0.0);
    vec3 plain = mix(horizon_color.rgb, zenith_color.rgb, 1.0 - exp(-up * 2.8));
    vec3 color = mix(plain, weather_sky(vec3(d.x, up, d.z)), has_sky);
    float s = max(dot(d, sun_direction.xyz), 0.0);
    float s4 = s * s * s * s;
    vec3 glow = sun_color.rgb * (1.0 - 0.75 * zenith_color.w);
    color += glow * (0.06 * s * s + 0.16 * s4 * s4) * (1.0 - has_sky);
    color += glow * (0.40 * pow(s, 90.0) + 9.0 * pow(s, 2600.0));
    vec3 mist = fog_color.rgb + glow * (0.30 * s * s * s);
    return mix(color, mist, exp(-up * 14.0) * 0.7);
}

// How much of the sky's light comes through the cloud that a rain area hangs from; the cloud itself
// is drawn over it, and this is what water mirrors.
float under_cloud(vec3 d, int i) {
    float rise = area_cloud[i].x - camera.y;
    if (rise <= 0.0) return 1.0;
    vec2 p = camera.xz + d.xz * (rise / max(d.y, 0.02)) - area_shape[i].xy;
    vec2 turn = area_turn[i].xy;
    vec2 q = vec2(p.x * turn.x - p.y * turn.y, p.x * turn.y + p.y * turn.x) * area_shape[i].zw;
    return 1.0 - area_cloud[i].y * (1.0 - smoothstep(0.55, 1.45, length(q)));
}

void main() {
    vec2 disc = (v_uv - 0.5) / SKY_RIM;
    float r2 = dot(disc, disc);
    vec3 d = vec3(2.0 * disc.x, 1.0 - r2, 2.0 * disc.y) / (1.0 + r2);
    vec3 color = air(d);
    for (int i = 0; i < int(fog_color.w); i++) color *= under_cloud(d, i);
    color = mix(color, fog_color.rgb, exp(-max(d.y, 0.0) * 24.0) * 0.35);
    // Fog overhead: a layer on a round Earth.
    float up = max(d.y, 0.0);
    color = mix(fog_light(d), color, exp(-fog_law.x * inversesqrt(up * up + fog_law.y)));
    out_color = vec4(tone(color) + (hash(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}
