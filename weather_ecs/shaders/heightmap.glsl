// What rain meets first, for a game's own shaders; see docs/collisions.md. `WeatherHeightmap.use(program)`
// binds what is declared here. After a game's own #version line; GLSL 3.30 or newer.
layout(std140) uniform WeatherHeightmap
{
    mat4 weather_height_matrix;
    vec4 weather_height_range;
};
uniform sampler2D weather_height_map;

// Height in m of what rain meets first on its way to p, along its mean fall; -1e9 where it meets
// nothing, and outside the map.
float weather_rain_meets(vec3 p)
{
    vec3 m = (weather_height_matrix * vec4(p, 1.0)).xyz;
    bool known = weather_height_range.w > 0.5 && all(greaterThan(m.xy, vec2(0.0)))
        && all(lessThan(m.xy, vec2(1.0)));
    float depth = known ? textureLod(weather_height_map, m.xy, 0.0).r : 1.0;
    return depth < 1.0 ? weather_height_range.x - depth * weather_height_range.y : -1e9;
}

// 1 where rain reaches p, 0 under cover that is more than a quarter of a metre above it.
float weather_rained_on(vec3 p)
{
    return 1.0 - smoothstep(0.15, 0.35, weather_rain_meets(p) - p.y);
}
