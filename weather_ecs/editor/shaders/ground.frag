#version 330 core
// Fields and woods in haze, and a grid of one kilometre; the sky shows where the haze is full.
#include "sky.glsl"
uniform vec4 ground_eye;
uniform float ground_grid;  // strength of the grid's lines
in vec3 vs_place;
out vec4 color;

const float HAZE = 14000.0;  // m in which two thirds of a sight are lost

float hash(vec2 p)
{
    return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453);
}

float noise(vec2 p)
{
    vec2 i = floor(p), f = p - i;
    f = f * f * (3.0 - 2.0 * f);
    float low = mix(hash(i), hash(i + vec2(1.0, 0.0)), f.x);
    return mix(low, mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), f.x), f.y);
}

float lines(vec2 p, float every)
{
    vec2 g = p / every, width = fwidth(g);
    vec2 near = abs(fract(g - 0.5) - 0.5) / max(width, 1e-6);
    vec2 line = clamp(1.1 - near, 0.0, 1.0) * clamp(1.0 - 2.0 * width, 0.0, 1.0);
    return max(line.x, line.y);
}

void main()
{
    vec3 way = vs_place - ground_eye.xyz;
    float far = length(way);
    vec3 sky = weather_sky(way / far);
    float left = exp(-far / HAZE);
    float broad = noise(vs_place.xz / 1900.0), fine = noise(vs_place.xz / 430.0 + 7.0);
    float woods = smoothstep(0.42, 0.62, 0.65 * broad + 0.35 * fine);
    vec3 tint = mix(vec3(0.62, 0.70, 0.36), vec3(0.26, 0.40, 0.25), woods);
    vec3 land = weather_sky_ground.rgb * tint * (0.9 + 0.3 * fine);
    land *= 1.0 + ground_grid * lines(vs_place.xz, 1000.0);
    vec3 light = mix(sky, land, left);
    vec3 over = 1.0 + max(light - 0.4, 0.0) * (0.5 / 0.6);
    vec3 bent = 1.0 - 0.6 / (over * over);
    light = mix(light, bent, greaterThan(light, vec3(0.4)));
    color = vec4(pow(max(light, vec3(0.0)), vec3(1.0 / 2.2)), 1.0);
}
