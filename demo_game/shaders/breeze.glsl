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
