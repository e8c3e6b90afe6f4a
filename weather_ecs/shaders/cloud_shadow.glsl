// The clouds' shadows for a game's own shader; see docs/cloud-drawing.md. `CloudShadow.use(program)` binds
// what is declared here. After a game's own #version line; GLSL 3.30 or newer.
layout(std140) uniform WeatherCloudShadow
{
    vec4 weather_shadow_frame;
    vec4 weather_shadow_sun;
};
uniform sampler2D weather_shadow_map;

// 0 to 1: how much of the sun comes through the clouds to p, a place below them, m.
float weather_sunlight(vec3 p)
{
    vec2 level = p.xz - (p.y - weather_shadow_sun.z) * weather_shadow_sun.xy;
    vec2 uv = (level - weather_shadow_frame.xy) * weather_shadow_frame.z;
    // Beyond the map a middling share, reached slowly.
    vec2 inside = clamp(8.0 - 16.0 * abs(uv), 0.0, 1.0);
    float through = mix(0.8, texture(weather_shadow_map, uv + 0.5).r, inside.x * inside.y);
    return mix(1.0, through, weather_shadow_frame.w);
}
