// Light of lightning, while there is any. n unit normal, p world place; linear RGB.
#include "weather.glsl"

vec3 flash_light(vec3 p, vec3 n) {
    if (drift.y < 0.5) return vec3(0.0);
    return weather_flash(p, n);
}

// What the sky shows of it, in display values.
vec3 flash_on_sky(vec3 shown) {
    if (drift.y < 0.5) return shown;
    vec3 light = weather_flash(camera.xyz, vec3(0.0, 1.0, 0.0));
    return 1.0 - (1.0 - shown) * exp(-0.55 * light);
}
