// The sky's radiance into a map of directions; physics/sky_map.py in NumPy.
#include <block:SkyLights>

uniform sampler2D sky_tables;  // rows: air of the sun, its haze, air of the moon, its haze

out vec4 color;

const float ROWS = 32.0;
const float COLUMNS = 32.0;
const float SIZE = 128.0;
const float G = 0.76;
const float RIM = 0.01771786;  // physics.haze.RIM

vec3 table(float part, vec2 place)
{
    vec2 at = vec2(0.5 + place.x * (COLUMNS - 1.0), ROWS * part + 0.5 + place.y * (ROWS - 1.0));
    return textureLod(sky_tables, at / vec2(COLUMNS, 4.0 * ROWS), 0.0).rgb;
}

float haze_phase(float c)
{
    float g2 = G * G;
    float factor = 3.0 * (1.0 - g2) / (8.0 * 3.14159265 * (2.0 + g2));
    return factor * (1.0 + c * c) / pow(1.0 + g2 - 2.0 * G * c, 1.5);
}

vec3 source(float part, vec3 d, vec3 to)
{
    float flat_length = max(length(d.xz), 1e-6) * max(length(to.xz), 1e-6);
    float c = clamp(dot(d.xz, to.xz) / flat_length, -1.0, 1.0);
    vec2 place = vec2(sqrt(0.5 - 0.5 * c), sqrt(d.y));
    return table(part, place) + table(part + 1.0, place) * haze_phase(dot(d, to));
}

void main()
{
    vec2 place = (gl_FragCoord.xy - 0.5) / (SIZE - 1.0) * 2.0 - 1.0;
    vec2 p = 0.5 * vec2(place.x + place.y, place.x - place.y);
    float r = abs(p.x) + abs(p.y);
    float up = (1.0 - r * r) * (1.0 - r * r);
    p *= sqrt(max(1.0 - up * up, 0.0)) / max(length(p), 1e-9);
    vec3 d = vec3(p.x, up, p.y);
    vec3 light = source(0.0, d, sky_sun.xyz) + source(2.0, d, sky_moon.xyz);
    light += sky_overcast.rgb * ((1.0 + 2.0 * up) / 3.0);
    float low = 1.0 - up;
    light += sky_night.rgb * (1.0 + 0.8 * low * low * low);
    light = mix(sky_haze.rgb, light, exp(-sky_haze.w / (up + RIM)));
    vec3 dark = dot(light, vec3(0.2126, 0.7152, 0.0722)) * sky_dark.rgb;
    color = vec4(mix(light, dark, sky_dark.w), 1.0);
}
