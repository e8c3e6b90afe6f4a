// A pixel's own grain, under one step of an 8-bit target, keeps soft ramps from banding.
float pixel_grain()
{
    float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    return (grain - 0.5) * (1.6 / 255.0);
}
