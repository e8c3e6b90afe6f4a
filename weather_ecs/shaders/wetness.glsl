// The weather's water and snow for a game's own shaders; see docs/wetness.md. `WetnessMap.use(program)` binds
// what is declared here. After a game's own #version line; GLSL 3.30 or newer.
layout(std140) uniform WeatherWetness
{
    vec4 weather_wet_frame;
    vec4 weather_wet_fall;
    vec4 weather_wet_far_place;
};
uniform sampler2D weather_wet_map;
uniform sampler2D weather_wet_far;

// mm of water on level ground at p under the open sky, from a few metres' cells; to 250 m off.
float weather_open_wetness(vec3 p)
{
    vec2 uv = (p.xz - weather_wet_far_place.xy) * weather_wet_far_place.z;
    vec2 inside = clamp(8.0 - 16.0 * abs(uv), 0.0, 1.0);
    return texture(weather_wet_far, uv + 0.5).r * inside.x * inside.y;
}

// Where p is in the map, from which `weather_water_at` has the rest. Linear in p: a vertex shader may
// hand it on, which spares the pixels the block.
vec2 weather_wet_place(vec3 p)
{
    vec2 uv = (p.xz + p.y * weather_wet_fall.xy - weather_wet_frame.xy) * weather_wet_frame.z;
    return weather_wet_fall.z > 0.5 ? uv + 0.5 : vec2(-9.0);
}

// mm of water at a place of the map and a height in m; `open_sky` where the map ends: what
// weather_open_wetness says there, for which a game may ask in the vertex shader too.
float weather_water_at(vec2 place, float height, float open_sky)
{
    vec2 here = texture(weather_wet_map, place).rg;
    float below = here.g - height;
    // Under cover with a soft edge; what stands above the map's surface is not in it.
    vec2 aside = abs(place - 0.5);
    bool mapped = max(aside.x, aside.y) < 0.5 && below > -0.6;
    return mapped ? here.r * (1.0 - smoothstep(0.35, 0.8, below)) : open_sky;
}

// The same at p, m.
float weather_water_here(vec3 p, float open_sky)
{
    return weather_water_at(weather_wet_place(p), p.y, open_sky);
}

// mm of water at p on what rain meets there; 0 under cover, the open sky's where the map ends.
float weather_water(vec3 p)
{
    return weather_water_here(p, weather_open_wetness(p));
}

// mm of water that lie as snow on level ground at p under the open sky; to 250 m off.
float weather_open_snow(vec3 p)
{
    vec2 uv = (p.xz - weather_wet_far_place.xy) * weather_wet_far_place.z;
    vec2 inside = clamp(8.0 - 16.0 * abs(uv), 0.0, 1.0);
    return texture(weather_wet_far, uv + 0.5).g * inside.x * inside.y;
}

// Depth in m of the snow at p on a surface with a unit normal; 0 under cover and on what is steep.
// For what moves use `Weather.snow_on` instead: the map knows what stands still.
float weather_snow(vec3 p, vec3 normal)
{
    float stays = smoothstep(0.5, 0.8, normal.y);
    if (stays <= 0.0) return 0.0;
    vec2 uv = (p.xz + p.y * weather_wet_fall.xy - weather_wet_frame.xy) * weather_wet_frame.z;
    float snow = -1.0;
    if (weather_wet_fall.z > 0.5 && max(abs(uv.x), abs(uv.y)) < 0.5) {
        vec3 here = texture(weather_wet_map, uv + 0.5).rgb;
        float below = here.g - p.y;
        if (below > -0.6) snow = here.b * (1.0 - smoothstep(0.35, 0.8, below));
    }
    return 0.01 * stays * (snow < 0.0 ? weather_open_snow(p) : snow);
}

// 0 to 1: how much of a surface so deep a snow hides.
float weather_snow_cover(float depth)
{
    return 1.0 - exp(-depth / 0.003);
}

// mm of water on a surface at p with a unit normal: less the more it is turned from the rain.
float weather_wetness(vec3 p, vec3 normal)
{
    float facing = dot(normal, normalize(vec3(-weather_wet_fall.x, 1.0, -weather_wet_fall.y)));
    return weather_water(p) * smoothstep(-0.2, 0.6, facing);
}

// 0 to 1: how much of a puddle so much water makes. `relief`, mm, is the game's own fine relief over
// its deepest hollows, of which the weather knows nothing: there the water of the film around runs
// together, as it stands in the larger hollows of the occluders.
float weather_pooled(float water, float relief)
{
    return clamp(6.0 * min(water, 1.0) + max(water - 1.0, 0.0) - relief, 0.0, 1.0);
}

// The same at p on a surface with a unit normal; none on slopes.
float weather_puddle(vec3 p, vec3 normal, float relief)
{
    return weather_pooled(weather_water(p), relief) * smoothstep(0.90, 0.98, normal.y);
}

// 0 to 1: how dark and glossy so much water makes a surface that can soak it up.
float weather_damp(float water)
{
    return 1.0 - exp(-water / 0.12);
}
