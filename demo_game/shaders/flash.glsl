// Light of lightning, while there is any. n unit normal, p world place; linear RGB.
#include "weather.glsl"

vec3 flash_light(vec3 p, vec3 n) {
    if (drift.y < 0.5) return vec3(0.0);
    return weather_flash(p, n);
}

// What it leaves of the sky's darkness, in display values: the same for a whole picture, so that
// pixels have it from their vertices.
vec3 flash_left() {
    if (drift.y < 0.5) return vec3(1.0);
    return exp(-0.55 * weather_flash(camera.xyz, vec3(0.0, 1.0, 0.0)));
}

vec3 flash_on_sky(vec3 shown, vec3 left) {
    return 1.0 - (1.0 - shown) * left;
}
