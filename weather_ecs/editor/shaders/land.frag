#version 330
// The map of the land, painted once: blocks of some 900 m, each with fields along a heading of its
// own, and woods. Square roots of linear RGB.
in vec3 v_way;  // m: x, z and 0

out vec4 out_color;

float noise(vec2 p)
{
    vec2 cell = floor(p), f = p - cell;
    f *= f * (3.0 - 2.0 * f);
    vec4 at = vec4(cell, cell + 1.0);
    vec4 h = fract(sin(vec4(at.x * 127.1 + at.y * 311.7, at.z * 127.1 + at.y * 311.7,
                            at.x * 127.1 + at.w * 311.7, at.z * 127.1 + at.w * 311.7)) * 43758.545);
    return mix(mix(h.x, h.y, f.x), mix(h.z, h.w, f.x), f.y);
}

void main()
{
    vec2 p = v_way.xy;
    vec2 bent = p + 420.0 * (vec2(noise(p / 1300.0), noise(p.yx / 1500.0 + 7.0)) - 0.5);
    vec2 block = floor(bent / 900.0);
    float turn = 6.283 * fract(sin(dot(block, vec2(39.346, 11.135))) * 4375.85);
    vec2 along = mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * bent;
    vec2 field = along / vec2(330.0, 140.0 + 90.0 * fract(turn * 3.7)) + 0.12 * noise(p / 60.0);
    float kind = fract(sin(dot(floor(field) + block, vec2(12.9898, 78.233))) * 4375.85);
    vec2 rim = (0.5 - abs(fract(field) - 0.5)) * vec2(330.0, 180.0);
    float hedge = smoothstep(14.0, 5.0, min(rim.x, rim.y));
    vec3 crop = kind < 0.35 ? vec3(0.085, 0.125, 0.034)
              : kind < 0.62 ? vec3(0.155, 0.165, 0.058)
              : kind < 0.8 ? vec3(0.21, 0.175, 0.075) : vec3(0.062, 0.1, 0.03);
    crop *= 0.9 + 0.2 * noise(p / 40.0);
    crop = mix(crop, vec3(0.035, 0.06, 0.02), 0.8 * hedge);
    float edge = noise(p / 700.0 + 3.0) + 0.16 * noise(p / 130.0) + 0.07 * noise(p / 40.0);
    float wood = smoothstep(0.78, 0.80, edge);
    crop = mix(crop, vec3(0.024, 0.046, 0.015) * (0.75 + 0.5 * noise(p / 21.0)), wood);
    out_color = vec4(sqrt(crop), 1.0);
}
