#version 330 core
// Fields and woods in haze, and a grid of one kilometre; the sky shows where the haze is full.
uniform float ground_grid;  // strength of the grid's lines
uniform sampler2D ground_tile;  // two noises, broad and fine
in vec2 vs_place;
in vec3 vs_haze;
in float vs_left;
flat in vec3 vs_field;
flat in vec3 vs_wood;
out vec4 color;

float lines(vec2 p, float every)
{
    vec2 g = p / every, width = max(fwidth(g), 1e-6);
    vec2 line = clamp(1.1 - abs(fract(g - 0.5) - 0.5) / width, 0.0, 1.0);
    line *= clamp(1.0 - 2.0 * width, 0.0, 1.0);
    return max(line.x, line.y);
}

void main()
{
    vec2 parts = texture(ground_tile, vs_place / 19000.0).rg;
    float woods = clamp((0.65 * parts.r + 0.35 * parts.g - 0.42) * 5.0, 0.0, 1.0);
    vec3 land = mix(vs_field, vs_wood, woods) * (0.93 + 0.14 * parts.g);
    land *= 1.0 + ground_grid * lines(vs_place, 1000.0);
    color = vec4(mix(vs_haze, land, vs_left), 1.0);
}
