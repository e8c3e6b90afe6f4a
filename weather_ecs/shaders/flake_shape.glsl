// A large flake is the square of its picture; a small one a triangle of about its area, which costs
// half as much as one around it. FAR: all are small.
const float LARGE = 2.5;  // pixels, radius from which on it shows what a triangle cuts off
const vec2[3] TRIANGLE = vec2[3](vec2(0.0, 1.0), vec2(-0.8660254, -0.5), vec2(0.8660254, -0.5));

bool is_square(float radius)
{
#ifdef FAR
    return false;
#else
    return radius >= LARGE;
#endif
}

// The triangle's reach, in radii.
float triangle_reach(float radius)
{
    return mix(1.76, 2.1, clamp((radius - 1.0) * 0.8, 0.0, 1.0));
}

// The smallest lose a little at three sides, and have it back all over.
float flake_denser(float radius)
{
    return is_square(radius) ? 1.0 : 1.078 - 0.262 * (triangle_reach(radius) - 1.76);
}
