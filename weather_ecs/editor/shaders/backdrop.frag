#version 330
// The light of a sky that has no atmosphere, behind everything.
#include "weather.glsl"
#include "sky.glsl"

in vec3 v_way;

out vec4 out_color;

void main()
{
    vec3 way = normalize(v_way);
    vec3 light = weather_sky_fog(weather_sky(way), way);
    out_color = vec4(pow(max(light, 0.0), vec3(1.0 / 2.2)), 1.0);
}
