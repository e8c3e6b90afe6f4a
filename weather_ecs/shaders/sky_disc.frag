// The sun with its darker limb and the glare round it, or (MOON) the moon, lit from where the sun is.
#include "sky.glsl"
#include "sky_show.glsl"

uniform vec3 disc_direction;
uniform vec3 disc_right;
uniform vec3 disc_up;
uniform vec2 disc_size;
uniform vec3 disc_light;
uniform vec3 disc_sun;  // towards the sun

in vec3 vs_direction;
in vec2 vs_place;
out vec4 color;

#ifdef MOON
// The seas, where they are: x to the moon's east, y north, radius and depth.
const int SEAS = 13;
const vec4 SEA[SEAS] = vec4[](
    vec4(-0.24, 0.53, 0.30, 1.0), vec4(0.27, 0.46, 0.19, 1.0), vec4(0.48, 0.15, 0.23, 1.0),
    vec4(0.81, 0.29, 0.11, 1.0), vec4(0.74, -0.10, 0.17, 0.9), vec4(0.55, -0.27, 0.11, 0.8),
    vec4(-0.27, -0.33, 0.22, 0.9), vec4(-0.57, -0.40, 0.13, 1.0), vec4(-0.70, 0.30, 0.28, 0.9),
    vec4(-0.55, 0.02, 0.26, 0.9), vec4(0.04, 0.21, 0.10, 0.6), vec4(0.00, 0.84, 0.13, 0.5),
    vec4(-0.14, -0.68, 0.10, -0.7));

float bumps(vec2 p)
{
    return sin(7.0 * p.x + 3.0 * sin(5.0 * p.y)) * sin(6.0 * p.y + 2.5 * sin(8.0 * p.x));
}

float albedo(vec2 p)
{
    vec2 q = p + 0.035 * vec2(bumps(p * 2.3), bumps(p.yx * 2.9 + 1.7));
    float dark = 0.0;
    for (int i = 0; i < SEAS; i++) {
        float away = length(q - SEA[i].xy) / SEA[i].z;
        dark += SEA[i].w * (1.0 - smoothstep(0.55, 1.25, away));
    }
    return 1.0 - 0.42 * clamp(dark, -0.5, 1.0) + 0.05 * bumps(p * 5.1);
}
#endif

void main()
{
    vec3 d = normalize(vs_direction);
    float q = length(vs_place);
    float edge = clamp(0.5 + (1.0 - q) / max(fwidth(q), 1e-4), 0.0, 1.0);
    float left = sky_left(d);
    vec3 sky = sky_in_fog(weather_sky(d), d);
#ifdef MOON
    float deep = sqrt(max(1.0 - q * q, 0.0));
    vec3 normal = vs_place.x * disc_right + vs_place.y * disc_up - deep * disc_direction;
    float incident = dot(normal, disc_sun);
    // Lommel and Seeliger's law: a full moon is as bright at its rim as in its middle.
    float lit = max(incident, 0.0) / max(max(incident, 0.0) + deep, 1e-3) * 2.0;
    lit = min(lit, 1.3) * smoothstep(0.0, 0.06, incident);
    float shade = albedo(vs_place) * (lit + 0.004);
    color = vec4(sky_shown(sky + left * shade * disc_light), edge);
#else
    float deep = sqrt(max(1.0 - q * q, 0.0));
    float rim = max(1.0 - q / disc_size.y, 0.0);
    float glare = 0.15 / (1.0 + q * q * 0.16) * rim * rim;
    vec3 light = disc_light * (edge * (0.4 + 0.6 * deep) + glare);
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    color = vec4(sky_shown(sky + left * light) + (noise - 0.5) * (1.0 / 255.0), 1.0);
#endif
}
