// Waves of period 1. Drops and flakes take dozens of sines, and where these are not in hardware they
// are most of the work.

// sin(2 pi x) up to a quarter turn, to 1e-6.
vec3 quarter_sine(vec3 x)
{
    vec3 w = x * x;
    return x * (6.2831640 + w * (-41.337142 + w * (81.340769 - 70.993430 * w)));
}

vec2 quarter_sine(vec2 x)
{
    vec2 w = x * x;
    return x * (6.2831640 + w * (-41.337142 + w * (81.340769 - 70.993430 * w)));
}

// cos(2 pi x).
vec3 wave(vec3 x)
{
    return quarter_sine(0.25 - abs(x - floor(x + 0.5)));
}

vec2 wave(vec2 x)
{
    return quarter_sine(0.25 - abs(x - floor(x + 0.5)));
}
