// Paints the sky's map: gradient, sun, drifting clouds, and a heavy cloud above every rain area.
#include "frame.glsl"
#include "sky_map.glsl"

uniform sampler2D cloud_map;

in vec2 v_uv;
out vec4 out_color;

float hash(vec2 p) {
    return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

vec3 air(vec3 d) {
    float up = max(d.y, 0.0);
    vec3 color = mix(horizon_color.rgb, zenith_color.rgb, 1.0 - exp(-up * 2.6));
    float s = max(dot(d, sun_direction.xyz), 0.0);
    float s4 = s * s * s * s;
    float veil = 1.0 - 0.75 * zenith_color.w;
    vec3 glow = sun_color.rgb * veil;
    color += glow * (0.10 * s * s + 0.22 * s4 * s4 + 0.55 * pow(s, 90.0) + 9.0 * pow(s, 2600.0));
    return mix(color, fog_color.rgb + glow * (0.32 * s * s * s), exp(-up * 16.0) * 0.65);
}

// Two layers on flat ceilings, bent down to the horizon. rgb colour, a cover.
vec4 layer(vec3 d, float cover) {
    float up = max(d.y, 0.0) + 0.10;
    vec2 drift = wind.xy * camera.w;
    vec2 p = d.xz / up;
    vec2 q = p * 0.075 + drift * 0.00035;
    float low = texture(cloud_map, q).r;
    float fine = texture(cloud_map, q * 3.7 + 0.31).r;
    float density = low * 0.72 + fine * 0.28;
    float edge = mix(0.66, 0.30, cover);
    float body = smoothstep(edge, edge + 0.30, density);
    float ahead = texture(cloud_map, q - sun_direction.xz * 0.022).r;
    float lit = clamp(0.62 + 2.6 * (low - ahead), 0.0, 1.0);
    float s = max(dot(d, sun_direction.xyz), 0.0);
    vec3 bright = horizon_color.rgb * 0.78 + sun_color.rgb * (0.42 + 0.5 * s * s * s * s);
    vec3 dark = mix(zenith_color.rgb, horizon_color.rgb, 0.45) * 0.72;
    vec3 color = mix(bright, dark, clamp(0.15 + 0.8 * body * (0.4 + 0.6 * cover), 0.0, 1.0));
    color = mix(dark, color, 0.35 + 0.65 * lit) * (1.0 - 0.25 * cover * body);
    float wisp = smoothstep(0.52, 0.80, texture(cloud_map, p * 0.030 + drift * 0.00018).g);
    float far = smoothstep(0.0, 0.22, d.y);
    body *= far;
    wisp *= 0.38 * far * (1.0 - body) * (1.0 - 0.6 * cover);
    vec3 mixed = (color * body + bright * wisp) / max(body + wisp, 0.001);
    return vec4(mixed, min(body * 0.94 + wisp, 1.0));
}

// The cloud that a rain area hangs from: a flattened ellipsoid with a torn edge.
vec4 storm(vec3 d, int i) {
    vec4 shape = area_shape[i];
    vec4 cloud = area_cloud[i];
    vec2 turn = area_turn[i].xy;
    vec2 off = camera.xz - shape.xy;
    vec2 o = vec2(off.x * turn.x - off.y * turn.y, off.x * turn.y + off.y * turn.x);
    vec2 w = vec2(d.x * turn.x - d.z * turn.y, d.x * turn.y + d.z * turn.x);
    vec3 origin = vec3(o * shape.zw / cloud.z, (camera.y - cloud.x) / cloud.y).xzy;
    vec3 way = vec3(w * shape.zw / cloud.z, d.y / cloud.y).xzy;
    float along = max(-dot(origin, way) / dot(way, way), 0.0);
    vec3 near = origin + way * along;
    float miss = length(near);
    vec2 p = near.xz * 0.33 + vec2(d.x, d.z) / (abs(d.y) + 0.35) * 0.16 + wind.xy * camera.w * 0.0006;
    float low = texture(cloud_map, p).r;
    float fine = texture(cloud_map, p * 3.1 + 0.17).r;
    float torn = (low - 0.5) * 0.75 + (fine - 0.5) * 0.30;
    float body = 1.0 - smoothstep(0.62, 1.18, miss + torn);
    // The shaft below, a darker air; the rain itself is drawn over it.
    vec2 flat_way = normalize(d.xz + 1e-5);
    vec2 fw = vec2(flat_way.x * turn.x - flat_way.y * turn.y, flat_way.x * turn.y + flat_way.y * turn.x);
    vec2 fo = o * shape.zw, fd = fw * shape.zw;
    float reach = max(-dot(fo, fd) / dot(fd, fd), 0.0);
    float aside = length(fo + fd * reach);
    float column = (1.0 - smoothstep(0.75, 1.7, aside + torn * 0.5)) * smoothstep(-0.05, 0.05, d.y);
    column *= 1.0 - smoothstep(0.0, 1.0, d.y * 1.4);
    vec3 grey = mix(zenith_color.rgb, horizon_color.rgb, 0.5);
    grey = mix(grey, vec3(dot(grey, vec3(0.3, 0.6, 0.1))), 0.45);
    float top = clamp(near.y * 0.8 + 0.15 + torn, 0.0, 1.0);
    float side = max(dot(normalize(vec3(near.x, 0.4, near.z)), sun_direction.xyz), 0.0);
    vec3 color = grey * (0.30 + 0.34 * low + 0.10 * fine);
    color += (sun_color.rgb * 0.30 + grey * 0.30) * top * (0.25 + 0.75 * side);
    float share = max(body, 0.50 * column);
    color = mix(grey * 0.50, color, body / max(share, 0.001));
    return vec4(color, share * cloud.w);
}

void main() {
    vec2 disc = (v_uv - 0.5) / SKY_RIM;
    float r2 = dot(disc, disc);
    vec3 d = vec3(2.0 * disc.x, 1.0 - r2, 2.0 * disc.y) / (1.0 + r2);
    vec3 color = air(d);
    vec4 high = layer(d, zenith_color.w);
    color = mix(color, high.rgb, high.a);
    for (int i = 0; i < int(fog_color.w); i++) {
        vec4 cloud = storm(d, i);
        color = mix(color, cloud.rgb, cloud.a);
    }
    float mist = exp(-max(d.y, 0.0) * 22.0) * 0.55;
    color = mix(color, fog_color.rgb, mist * 0.6);
    vec3 coded = sqrt(clamp(color * 0.5, 0.0, 1.0));
    out_color = vec4(coded + (hash(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}
