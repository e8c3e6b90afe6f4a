// The air's velocity at a place: the wind by its profile, and three octaves of eddies in it that
// are free of divergence; physics/turbulence.py is its oracle, symbol for symbol.
#include "wave.glsl"
#include <block:AirFlow>

const float LOWEST_WIND = 0.03;    // m above the ground; below, the wind is that there
const float HIGHEST_WIND = 300.0;  // m; above, too
const mat3 EDDY_AXES[3] = mat3[3](
    mat3(0.66666667, 0.66666667, -0.33333333,
         -0.33333333, 0.66666667, 0.66666667,
         0.66666667, -0.33333333, 0.66666667),
    mat3(0.28571429, 0.42857143, 0.85714286,
         0.42857143, -0.85714286, 0.28571429,
         0.85714286, 0.28571429, -0.42857143),
    mat3(0.11111111, -0.44444444, 0.88888889,
         0.88888889, 0.44444444, 0.11111111,
         -0.44444444, 0.77777778, 0.44444444)
);

// Without the turbulence, m/s.
vec3 mean_velocity(vec3 p)
{
    float height = clamp(p.y - air_shape.y, LOWEST_WIND, HIGHEST_WIND);
    return air_wind.xyz * exp2(air_shape.x * log2(height * air_wind.w));
}

vec3 eddies_of(int k, vec3 p, float height)
{
    vec4 octave = air_octave[k];
    mat3 axes = EDDY_AXES[k];
    vec3 q = (p * axes * octave.w + octave.xyz) * 0.15915494;
    vec3 c = wave(q);
    vec3 s = wave(q - 0.25);
    vec3 u = axes * (s.zxy + c.yzx);
    float a = min(octave.w * height * 0.15915494, 0.25);
    vec2 ground = quarter_sine(vec3(a, 0.25 - a, 0.0)).xy;
    return air_gain[k] * vec3(ground.x * u.x + ground.y * u.z, ground.x * u.y,
                              ground.x * u.z - ground.y * u.x);
}

vec3 eddies(vec3 p)
{
    float height = max(p.y - air_shape.y, 0.0);
    return eddies_of(0, p, height) + eddies_of(1, p, height) + eddies_of(2, p, height);
}

// Of the eddies of each octave, the share that a thing takes on which falls through them at `speed`:
// drag makes it follow with the time constant speed / 9.8, and it meets so many waves a second, of
// directions of which the vertical is a third.
vec3 felt_shares(float speed)
{
    vec3 lag = vec3(air_octave[0].w, air_octave[1].w, air_octave[2].w) * (speed * speed * 0.0589145);
    return inversesqrt(lag * lag + 1.0);
}

vec3 eddies_felt(vec3 p, vec3 felt)
{
    float height = max(p.y - air_shape.y, 0.0);
    return eddies_of(0, p, height) * felt.x + eddies_of(1, p, height) * felt.y
        + eddies_of(2, p, height) * felt.z;
}

// At a place of the world, now, m/s. STEADY_AIR: it is the same everywhere, as in a calm. A variant
// of its own, because many compilers work out both sides of a branch for every drop.
vec3 air_velocity(vec3 p)
{
#ifdef STEADY_AIR
    return air_wind.xyz;
#else
    vec3 v = mean_velocity(p);
    if (air_gain.w > 0.0) v += eddies(p);
    return v;
#endif
}
