// Paints the sky's map: gradient, sun, mist. PAINTED: also drifting clouds, and a heavy cloud above
// every rain area, where the weather's own are too dear.
#include "frame.glsl"
#include "sky_map.glsl"
#include "tone.glsl"
#include "fog_light.glsl"

#ifdef PAINTED
uniform sampler2D cloud_map;
#endif

in vec2 v_uv;
out vec4 out_color;

float hash(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

// Clear air: gradient, the sun and its glow.
vec3 air(vec3 d) {
    float up = max(d.y, 0.0);
    vec3 color = mix(horizon_color.rgb, zenith_color.rgb, 1.0 - exp(-up * 2.8));
    float s = max(dot(d, sun_direction.xyz), 0.0);
    float s4 = s * s * s * s;
    vec3 glow = sun_color.rgb * (1.0 - 0.75 * zenith_color.w);
    color += glow * (0.06 * s * s + 0.16 * s4 * s4 + 0.40 * pow(s, 90.0) + 9.0 * pow(s, 2600.0));
    vec3 mist = fog_color.rgb + glow * (0.30 * s * s * s);
    return mix(color, mist, exp(-up * 14.0) * 0.7);
}

#ifdef PAINTED
// Clouds on flat ceilings, bent down to the horizon. rgb colour, a cover.
vec4 layer(vec3 d, float cover) {
    float up = max(d.y, 0.0) + 0.09;
    vec2 p = d.xz / up;
    vec2 q = p * 0.062 - drift.xy * 0.00009;
    float low = texture(cloud_map, q).r;
    float fine = texture(cloud_map, q * 3.3 + 0.31).r;
    float finer = texture(cloud_map, q * 9.1 + 0.77).r;
    float density = low * 0.66 + fine * 0.25 + finer * 0.09;
    float edge = mix(0.64, 0.26, cover);
    float body = smoothstep(edge, edge + 0.26, density);
    float ahead = texture(cloud_map, q + sun_direction.xz * 0.020).r;
    float lit = clamp(0.5 + 3.2 * (low - ahead) + 1.2 * (0.5 - fine), 0.0, 1.0);
    float s = max(dot(d, sun_direction.xyz), 0.0);
    vec3 sky = mix(horizon_color.rgb, zenith_color.rgb, 0.45);
    vec3 grey = mix(sky, vec3(dot(sky, vec3(0.3, 0.6, 0.1))), 0.4);
    vec3 bright = grey * 0.85 + sun_color.rgb * (0.40 + 0.55 * s * s * s * s);
    vec3 dark = grey * mix(0.74, 0.50, body);
    float thick = smoothstep(0.2, 1.0, body) * (0.35 + 0.65 * cover);
    vec3 color = mix(bright, dark, clamp(thick + 0.55 * (1.0 - lit), 0.0, 1.0));
    float wisp = smoothstep(0.48, 0.80, texture(cloud_map, p * 0.030 - drift.xy * 0.00005).g);
    float far = smoothstep(0.015, 0.20, d.y);
    body *= far;
    wisp *= 0.40 * far * (1.0 - body) * (1.0 - 0.6 * cover);
    vec3 mixed = (color * body + bright * wisp) / max(body + wisp, 0.001);
    return vec4(mixed, min(body * 0.95 + wisp, 1.0));
}

// The cloud that a rain area hangs from: a flattened ellipsoid with a torn edge.
vec4 storm(vec3 d, int i) {
    vec4 shape = area_shape[i];
    vec4 cloud = area_cloud[i];
    vec2 turn = area_turn[i].xy;
    vec2 off = camera.xz - shape.xy;
    vec2 o = vec2(off.x * turn.x - off.y * turn.y, off.x * turn.y + off.y * turn.x) * shape.zw;
    vec2 w = vec2(d.x * turn.x - d.z * turn.y, d.x * turn.y + d.z * turn.x) * shape.zw;
    vec3 origin = vec3(o.x / cloud.z, (camera.y - cloud.x) / cloud.y, o.y / cloud.z);
    vec3 way = vec3(w.x / cloud.z, d.y / cloud.y, w.y / cloud.z);
    float along = max(-dot(origin, way) / dot(way, way), 0.0);
    vec3 near = origin + way * along;
    float miss = length(near);
    vec2 side = d.xz / (abs(d.y) + 0.55);
    vec2 p = near.xz * 0.22 + side * 0.15 - drift.xy * 0.00016;
    float low = texture(cloud_map, p).r;
    float fine = texture(cloud_map, p * 2.9 + 0.17).r;
    float finer = texture(cloud_map, p * 7.3 + 0.43).r;
    float torn = (low - 0.5) * 0.85 + (fine - 0.5) * 0.40 + (finer - 0.5) * 0.16;
    float body = 1.0 - smoothstep(0.58, 1.08, miss + torn);
    // The shaft below, a darker air; the rain itself is drawn over it.
    float flat_length = max(length(d.xz), 1e-4);
    vec2 fd = w / flat_length;
    float reach = max(-dot(o, fd) / dot(fd, fd), 0.0);
    float aside = length(o + fd * reach);
    float streak = (texture(cloud_map, vec2(aside * 0.6 + d.x * 0.4, d.y * 0.06)).g - 0.5) * 0.4;
    float column = 1.0 - smoothstep(0.80, 1.45, aside + streak);
    float base = cloud.x - cloud.y - camera.y;  // the shaft ends where the cloud begins
    column *= 1.0 - smoothstep(0.7, 1.9, d.y / flat_length * max(reach, 12.0) / max(base, 8.0));
    vec3 sky = mix(zenith_color.rgb, horizon_color.rgb, 0.5);
    vec3 grey = mix(sky, vec3(dot(sky, vec3(0.3, 0.6, 0.1))) * vec3(0.96, 1.0, 1.06), 0.6);
    float top = smoothstep(-0.25, 0.9, near.y + torn * 0.8);
    float faced = 0.5 + 0.5 * dot(normalize(vec3(near.x, 0.35, near.z)), sun_direction.xyz);
    vec3 color = grey * (0.26 + 0.42 * low * low + 0.16 * (fine - 0.5) + 0.12 * (finer - 0.5));
    color += (sun_color.rgb * 0.26 * faced * faced + grey * 0.16) * top * (0.4 + fine);
    float share = max(body, 0.80 * column);
    color = mix(grey * (0.27 + 0.20 * streak), color, body / max(share, 0.001));
    return vec4(color, share * cloud.w);
}

#endif

void main() {
    vec2 disc = (v_uv - 0.5) / SKY_RIM;
    float r2 = dot(disc, disc);
    vec3 d = vec3(2.0 * disc.x, 1.0 - r2, 2.0 * disc.y) / (1.0 + r2);
    vec3 color = air(d);
#ifdef PAINTED
    vec4 high = layer(d, zenith_color.w);
    color = mix(color, high.rgb, high.a);
    for (int i = 0; i < int(fog_color.w); i++) {
        vec4 cloud = storm(d, i);
        color = mix(color, cloud.rgb, cloud.a);
    }
#endif
    color = mix(color, fog_color.rgb, exp(-max(d.y, 0.0) * 24.0) * 0.35);
    // Fog overhead: a layer on a round Earth.
    float up = max(d.y, 0.0);
    color = mix(fog_light(d), color, exp(-fog_law.x * inversesqrt(up * up + fog_law.y)));
    out_color = vec4(tone(color) + (hash(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}
