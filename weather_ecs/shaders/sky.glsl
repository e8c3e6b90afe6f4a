// The sky of the weather's `Atmosphere` for a game's own shaders, for reflections and backgrounds; see
// docs/sky.md. `WeatherSky.use(program)` binds what is declared here. After a game's own #version
// line; GLSL 3.30 or newer. Linear RGB as it is shown; world axes with y up.
layout(std140) uniform WeatherSkyLight
{
    vec4 weather_sky_ground;   // what the ground sends back; 1 where there is a map, else 0
    vec4 weather_sky_zenith;   // without a map, the light of the sky
    vec4 weather_sky_horizon;
};
uniform sampler2D weather_sky_map;

// Light of the sky along a unit direction, without the discs of sun and moon; below the horizon that
// of the ground behind haze.
vec3 weather_sky(vec3 direction)
{
    float up = clamp(direction.y, 0.0, 1.0);
    float r = sqrt(1.0 - sqrt(up));
    vec2 p = direction.xz * (r / max(abs(direction.x) + abs(direction.z), 1e-6));
    vec2 place = 0.5 + (0.5 * 127.0 / 128.0) * vec2(p.x + p.y, p.x - p.y);
    vec3 sky = weather_sky_ground.w > 0.5
        ? textureLod(weather_sky_map, place, 0.0).rgb
        : mix(weather_sky_zenith.rgb, weather_sky_horizon.rgb, exp(-2.8 * up));
    return mix(weather_sky_ground.rgb, sky, exp(40.0 * min(direction.y, 0.0)));
}
