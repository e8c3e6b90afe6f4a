// A grid over the picture: the sky is smooth, and worked out at its corners.
#include "sky.glsl"
#include "sky_show.glsl"

in vec2 in_place;  // 0 to 1 over the picture

noperspective out vec3 vs_color;

void main()
{
    // Rows crowd round the horizon, where the sky changes most.
    float h = sky_law.z;
    float middle = 0.15 + 0.35 * (h + 1.0);
    float above = max(in_place.y - middle, 0.0) / (1.0 - middle);
    float below = max(middle - in_place.y, 0.0) / middle;
    float y = h + (1.0 - h) * above * sqrt(above) - (1.0 + h) * below * sqrt(below);
    vec2 place = vec2(in_place.x * 2.0 - 1.0, y);
    vec3 ray = vec3((place + sky_frustum.zw) * sky_frustum.xy, -1.0);
    vec3 d = normalize(ray.x * sky_right.xyz + ray.y * sky_up.xyz + ray.z * sky_back.xyz);
    vec3 light = weather_sky(d);
    if (d.y < 0.0) light = sky_below(light, d, weather_sky(vec3(d.x, 0.0, d.z)));
    vs_color = sky_shown(sky_in_fog(light + sky_flashed(d), d));
    gl_Position = vec4(place, 1.0, 1.0);
}
