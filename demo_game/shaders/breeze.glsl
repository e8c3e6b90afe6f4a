// The wind at a place: gusts come over the land from upwind, some metres before the camera.
#include "frame.glsl"

const float GUST_STEP = 0.5;  // s; also in render/breeze.py
const float UPWIND = 12.0;    // m

// m/s at p, (x, z).
float wind_at(vec2 p) {
    float along = dot(p - camera.xz, wind.xy) + UPWIND;
    float slot = clamp(along / (wind.z * GUST_STEP), 0.0, 14.99);
    int k = int(slot);
    float here = gusts[k >> 2][k & 3];
    k += 1;
    return mix(here, gusts[k >> 2][k & 3], fract(slot));
}

// How far grass leans with the wind at p, (x, z), as a share of its height: waves run before the
// wind, in broken lines, and the more so the more it blows.
float grass_lean(vec2 p) {
    float across = dot(p, vec2(-wind.y, wind.x));
    float wave = dot(p, wind.xy) * 0.35 - drift.w + 1.4 * sin(across * 0.19 + wind.w * 0.2);
    return 1.15 * (1.0 - exp(-wind_at(p) * 0.075)) * (0.68 + 0.32 * sin(wave));
}
