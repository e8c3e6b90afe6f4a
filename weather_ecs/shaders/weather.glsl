// The weather's air, light and wind for a game's own shaders; see docs/fog.md. `WeatherAir.use(program)`
// binds what is declared here. After a game's own #version line; GLSL 3.30 or newer. Colours are
// linear RGB, lengths in m, world axes with y up.
layout(std140) uniform WeatherAir
{
    vec4 weather_fog_color;      // rgb; extinction of the air and its fog, 1/m
    vec4 weather_fog_law;        // extinction with the rain and snow at the eye, 1/m; m of fog
                                 // overhead; extinction of the fog without the clean air, 1/m
    vec4 weather_sun_direction;  // towards the sun, unit
    vec4 weather_sun_color;
    vec4 weather_zenith_color;
    vec4 weather_horizon_color;
    vec4 weather_ground_color;
    vec4 weather_wind_now;       // m/s, gusts included, at the reference height; turbulence in m/s
    vec4 weather_wind_law;       // reference height; exponent of the growth; height of the ground
    vec4 weather_now;            // s, the weather's clock; rain and snow at the eye, mm/h of water
    vec4 weather_air;            // degrees Celsius at y = 0; humidity, 0 to 1; share of snow
    vec4 weather_flash_place;    // of lightning, m; 1/m2, how its light falls off
    vec4 weather_flash_color;    // there; 0 while there is none
};

// Share of a thing's own light left after so many metres of air and fog.
float weather_fog_left(float distance)
{
    return exp(-weather_fog_color.w * distance);
}

// Linear light as it arrives. The rain and snow in between are drawn by the weather itself.
vec3 weather_fog(vec3 light, float distance)
{
    return mix(weather_fog_color.rgb, light, weather_fog_left(distance));
}

// The same with what falls at the eye, for pictures over which the weather draws no veil of rain:
// reflections, maps, or a weather of a quality without veils.
vec3 weather_fog_and_rain(vec3 light, float distance)
{
    return mix(weather_fog_color.rgb, light, exp(-weather_fog_law.x * distance));
}

// Share of the sky's light that the fog overhead leaves, along a unit direction: a layer on a round
// Earth. Clean air counts as part of the sky.
float weather_sky_left(vec3 direction)
{
    float up = max(direction.y, 0.0) + sqrt(2.0 / 6.371e6 * weather_fog_law.y + 1e-9);
    return exp(-weather_fog_law.z * weather_fog_law.y / up);
}

// Linear light of a sky behind the fog.
vec3 weather_sky_fog(vec3 light, vec3 direction)
{
    return mix(weather_fog_color.rgb, light, weather_sky_left(direction));
}

// Light on a surface with a unit normal: the sky's half, the ground's half, and the sun where
// `lit` of it gets through, 0 to 1.
vec3 weather_light(vec3 normal, float lit)
{
    vec3 sky = 0.5 * (weather_zenith_color.rgb + weather_horizon_color.rgb);
    vec3 around = mix(weather_ground_color.rgb, sky, 0.5 + 0.5 * normal.y);
    return around + weather_sun_color.rgb * (lit * max(dot(normal, weather_sun_direction.xyz), 0.0));
}

// Light of lightning on a surface with a unit normal at the world place p; add it to the above.
vec3 weather_flash(vec3 p, vec3 normal)
{
    vec3 way = weather_flash_place.xyz - p;
    float away2 = dot(way, way);
    float facing = max(dot(normal, way) * inversesqrt(max(away2, 1e-6)), 0.0);
    return weather_flash_color.rgb * ((0.45 + 0.55 * facing) / (1.0 + away2 * weather_flash_place.w));
}

// m/s of wind at a world height.
vec3 weather_wind(float y)
{
    float height = clamp(y - weather_wind_law.z, 0.03, 300.0);
    return weather_wind_now.xyz * pow(height / weather_wind_law.x, weather_wind_law.y);
}
