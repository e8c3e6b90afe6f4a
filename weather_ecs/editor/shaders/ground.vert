#version 330 core
// The land below in rings round the eye, each a share farther than the last; light by the corner.
#include "sky.glsl"
uniform mat4 ground_matrix;
uniform vec3 ground_eye;  // m
out vec2 vs_place;
out vec3 vs_haze;
out float vs_left;
flat out vec3 vs_field;
flat out vec3 vs_wood;

const int SECTORS = 48;
const int RINGS = 40;
const float NEAR = 150.0, FAR = 150000.0;  // m
const float HAZE = 14000.0;  // m in which two thirds of a sight are lost

vec3 shown(vec3 light)
{
    vec3 over = 1.0 + max(light - 0.4, 0.0) * (0.5 / 0.6);
    vec3 bent = 1.0 - 0.6 / (over * over);
    light = mix(light, bent, greaterThan(light, vec3(0.4)));
    return pow(max(light, vec3(0.0)), vec3(1.0 / 2.2));
}

void main()
{
    // Strips of two corners a sector, one ring after the other.
    int ring = gl_InstanceID + (gl_VertexID & 1), sector = gl_VertexID >> 1;
    float turn = 6.28318531 * float(sector) / float(SECTORS);
    float reach = ring == 0 ? 0.0 : NEAR * pow(FAR / NEAR, float(ring - 1) / float(RINGS - 1));
    vs_place = ground_eye.xz + reach * vec2(cos(turn), sin(turn));
    vec3 way = vec3(vs_place.x, 0.0, vs_place.y) - ground_eye;
    float far = max(length(way), 1e-3);
    vs_haze = shown(weather_sky(way / far));
    vs_left = exp(-far / HAZE);
    vs_field = shown(weather_sky_ground.rgb * vec3(0.68, 0.76, 0.40));
    vs_wood = shown(weather_sky_ground.rgb * vec3(0.28, 0.42, 0.26));
    gl_Position = ground_matrix * vec4(vs_place.x, 0.0, vs_place.y, 1.0);
}
