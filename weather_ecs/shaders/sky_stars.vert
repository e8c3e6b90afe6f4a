// The stars, turned with sidereal time; twinkling, more so near the horizon.
#include "sky_show.glsl"

uniform mat3 star_axes;  // world = star_axes * equatorial
uniform vec3 star_law;   // magnitude of the faintest; factor on their light; s, the weather's clock

in vec4 in_star;  // equatorial direction; magnitude
in vec3 in_tint;

out vec3 vs_light;

void main()
{
    vec3 d = star_axes * in_star.xyz;
    float mass = 1.0 / max(d.y + 0.025, 0.025);
    float margin = star_law.x - in_star.w - 0.16 * (mass - 1.0);
    gl_Position = sky_position(d);
    gl_PointSize = 1.0;
    if (margin <= 0.0 || d.y <= 0.0)
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    float phase = dot(in_star.xyz, vec3(311.7, 127.1, 74.7)) * 40.0;
    float twinkle = 1.0 + min(0.04 * mass, 0.3) * sin(star_law.z * (7.0 + fract(phase) * 6.0) + phase);
    // What an eye sees of a star goes by a power of its light, and a bright one looks larger.
    float seen = star_law.y * twinkle * sky_left(d) * pow(10.0, 0.17 * min(margin, 8.0));
    float size = clamp(1.1 + 0.46 * seen, 1.7, 4.7) * sky_law.y;
    gl_PointSize = size;
    vs_light = in_tint * min(0.66 * seen * 2.0 * sky_law.y * sky_law.y / (size * size) + 0.04 * seen, 1.0);
}
