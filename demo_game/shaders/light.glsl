// Light at a vertex. n unit normal, p world position; all linear RGB.
const vec3 LAMP_COLOR = vec3(1.0, 0.62, 0.30);
const float SUN_STRENGTH = 2.7;   // of the sun against its colour
const float LAMP_STRENGTH = 1.5;

// x: share of daylight the rain clouds take at p, y: wetness they bring.
vec2 rain_cover(vec2 p) {
    vec2 cover = vec2(0.0);
    for (int i = 0; i < int(fog_color.w); i++) {
        vec2 d = p - area_shape[i].xy;
        vec2 turn = area_turn[i].xy;
        vec2 q = vec2(d.x * turn.x - d.y * turn.y, d.x * turn.y + d.y * turn.x);
        float r = length(q * area_shape[i].zw);
        cover.x = max(cover.x, area_turn[i].z * (1.0 - smoothstep(0.72, 1.35, r)));
        cover.y = max(cover.y, area_turn[i].w * (1.0 - smoothstep(0.86, 1.02, r)));
    }
    return vec2(cover.x, max(cover.y, sun_color.w));
}

vec3 sky_light(vec3 n, float dim) {
    vec3 above = mix(horizon_color.rgb, zenith_color.rgb, 0.45) * (1.0 - 0.35 * dim);
    vec3 below = ground_color.rgb * (0.55 + 0.45 * sun_direction.y) * (1.0 - 0.3 * dim);
    return mix(below, above, n.y * 0.5 + 0.5);
}

vec3 sun_light(float facing, float dim) {
    return sun_color.rgb * (SUN_STRENGTH * facing * (1.0 - 0.88 * dim));
}

// Premultiplied haze: colour * a + rgb. The haze glows towards the sun.
vec4 haze(vec3 p) {
    vec3 way = p - camera.xyz;
    float distance = length(way);
    float thin = exp(-distance * horizon_color.w);
    float glow = max(dot(way, sun_direction.xyz) / max(distance, 0.01), 0.0);
    vec3 color = fog_color.rgb + sun_color.rgb * (0.32 * glow * glow * glow) * (1.0 - zenith_color.w);
    return vec4(color * (1.0 - thin), thin);
}
