// Linear light of the sky to what an 8-bit target shows, through fog; physics/sky_map.shown in NumPy.
#include <block:SkyView>

const float SHOULDER = 0.4;
const float ROUND = 2.0 / 6.371e6;

vec3 sky_shown(vec3 linear)
{
    vec3 over = 1.0 + max(linear - SHOULDER, 0.0) * (0.5 / (1.0 - SHOULDER));
    vec3 bent = 1.0 - (1.0 - SHOULDER) / (over * over);
    vec3 light = mix(max(linear, vec3(0.0)), bent, greaterThan(linear, vec3(SHOULDER)));
    return pow(light, vec3(1.0 / 2.2));
}

// Share of the sky's light that the fog overhead leaves.
float sky_left(vec3 direction)
{
    float up = max(direction.y, 0.0) + sqrt(ROUND * sky_fog.w + 1e-9);
    return exp(-sky_law.x * sky_fog.w / up);
}

vec3 sky_in_fog(vec3 light, vec3 direction)
{
    return mix(sky_fog.rgb, light, sky_left(direction));
}

// What lightning adds to the light of the air: more where one looks through more of it.
vec3 sky_flashed(vec3 direction)
{
    return sky_flash.rgb * (1.0 - exp(-sky_flash.w / (max(direction.y, 0.0) + 0.05)));
}

// What is seen along a direction below the horizon; `land`: the ground there, `level`: the sky over it.
// physics/sky_floor.floor_light in NumPy.
vec3 sky_below(vec3 land, vec3 direction, vec3 level)
{
    float cloud = sky_floor.w * (1.0 - exp(40.0 * direction.y));
    land = mix(land, sky_floor.rgb, cloud);
    return mix(level, land, exp(-sky_law.w / (0.02 - direction.y)));
}

// At the far plane: whatever the scene has drawn is in front.
vec4 sky_position(vec3 direction)
{
    vec4 at = sky_turn * vec4(direction, 0.0);
    return at.xyww;
}
