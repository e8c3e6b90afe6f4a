// Linear light to what an 8-bit target shows; the power law that stands in for sRGB's curve.
vec3 encode(vec3 linear)
{
    return pow(max(linear, vec3(0.0)), vec3(1.0 / 2.2));
}
